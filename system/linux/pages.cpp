#include "system/pages.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace racebeam {
namespace {

[[noreturn]] void refuse(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

// Pages are either writable or executable for all threads.
CodeWriting::CodeWriting() = default;
CodeWriting::~CodeWriting() = default;

std::size_t page_size() { return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)); }

Pages::Pages(std::size_t size, Use) {
  size = whole_pages(size);
  void* const memory =
      ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) refuse("the system refuses memory");
  all_ = {static_cast<std::byte*>(memory), size};
}

Pages::~Pages() {
  if (!all_.empty()) ::munmap(all_.data(), all_.size());
}

void Pages::make_executable(std::size_t offset, std::size_t size) {
  auto* const first = reinterpret_cast<char*>(data() + offset);
#if !defined(__wasm__)  // WebAssembly does not have instructions in memory
  // The instruction caches of processors other than x86-64 may still have the earlier contents.
  __builtin___clear_cache(first, first + size);
#endif
  if (::mprotect(first, size, PROT_READ | PROT_EXEC) != 0) refuse("the system refuses executable memory");
}

void Pages::forbid(std::size_t offset, std::size_t size) {
  if (::mprotect(data() + offset, size, PROT_NONE) != 0) refuse("the system refuses a guard page");
}

void discard_pages(void* first, std::size_t size) { ::madvise(first, size, MADV_DONTNEED); }

void prefer_large_pages(void* memory, std::size_t size) { ::madvise(memory, size, MADV_HUGEPAGE); }
bool can_prefer_large_pages() { return true; }

}  // namespace racebeam
