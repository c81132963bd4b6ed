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

  // Both change the access to the pages of the `size` bytes from `offset` on. They throw std::system_error.
  void make_executable(std::size_t offset, std::size_t size);  // pages of code; they are no longer writable
  void forbid(std::size_t offset, std::size_t size);           // an access ends the process

 private:
  std::span<std::byte> all_;  // empty after a move
};

// During its lifetime, its thread can write to pages for code, but cannot execute the code. Only one such
// object may exist at a time.
class CodeWriting {
 public:
  CodeWriting();
  ~CodeWriting();  // NOLINT(performance-trivially-destructible): on macOS, it does something
  CodeWriting(const CodeWriting&) = delete;
  CodeWriting& operator=(const CodeWriting&) = delete;
};

// Returns `size`, rounded up to whole pages.
std::size_t whole_pages(std::size_t size);

// Discards the contents of these pages, and returns their memory to the system until they are used again.
void discard_pages(void* first, std::size_t size);

// Asks the system to use large pages for this memory, if it has them.
void prefer_large_pages(void* memory, std::size_t size);
bool can_prefer_large_pages();  // whether that has an effect

}  // namespace racebeam
