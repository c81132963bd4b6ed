// Memory in pages, whose access can be changed.
#pragma once

#include <cstddef>
#include <span>

namespace racebeam {

std::size_t page_size();

// Pages that can be read and written. The system provides memory for a page when it is used first.
class Pages {
 public:
  enum class Use { kData, kCode };  // code: it can be written only while CodeWriting lives

  explicit Pages(std::size_t size, Use use = Use::kData);  // in whole pages; throws std::system_error
  ~Pages();
  Pages(Pages&& other) noexcept;
  Pages& operator=(Pages&& other) noexcept;

  std::byte* data() const { return all_.data(); }
  std::size_t size() const { return all_.size(); }

  // Changes the access to the pages from `offset` on that have `size` bytes. Throws std::system_error.
  void make_executable(std::size_t offset, std::size_t size);  // of code; no longer writable
  void forbid(std::size_t offset, std::size_t size);           // an access ends the process

 private:
  std::span<std::byte> all_;  // empty after a move
};

// While it lives, its thread writes to pages for code, and cannot execute what is in them. One at a time.
class CodeWriting {
 public:
  CodeWriting();
  ~CodeWriting();
  CodeWriting(const CodeWriting&) = delete;
  CodeWriting& operator=(const CodeWriting&) = delete;
};

// `size` in whole pages.
std::size_t whole_pages(std::size_t size);

// The contents of these pages are lost, and their memory goes back to the system until they are used.
void discard_pages(void* first, std::size_t size);

// Large pages are better for this memory, if the system has them.
void prefer_large_pages(void* memory, std::size_t size);

}  // namespace racebeam
