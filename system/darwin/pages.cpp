#include "system/pages.hpp"

#include <libkern/OSCacheControl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace racebeam {
namespace {

// On Apple silicon, pages for code are executable for all threads but those that write (CodeWriting). The
// processor switches this for each thread. On x86-64, the access to the pages changes, as on Linux.
#if defined(__aarch64__)
constexpr bool kSwitches = true;
#else
constexpr bool kSwitches = false;
#endif

[[noreturn]] void refuse(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

std::byte* map(std::size_t size, bool is_code) {
  const int access = PROT_READ | PROT_WRITE | (is_code ? PROT_EXEC : 0);
  void* const memory = ::mmap(nullptr, size, access, MAP_PRIVATE | MAP_ANON | (is_code ? MAP_JIT : 0), -1, 0);
  if (memory == MAP_FAILED)
    refuse(is_code ? "the system refuses executable memory" : "the system refuses memory");
  return static_cast<std::byte*>(memory);
}

void switch_to_writing([[maybe_unused]] bool writes) {
#if defined(__aarch64__)
  ::pthread_jit_write_protect_np(writes ? 0 : 1);
#endif
}

}  // namespace

CodeWriting::CodeWriting() { switch_to_writing(true); }
CodeWriting::~CodeWriting() { switch_to_writing(false); }

std::size_t page_size() { return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)); }

Pages::Pages(std::size_t size, Use use) {
  size = whole_pages(size);
  all_ = {map(size, kSwitches && use == Use::kCode), size};
}

Pages::~Pages() {
  if (!all_.empty()) ::munmap(all_.data(), all_.size());
}

void Pages::make_executable(std::size_t offset, std::size_t size) {
  ::sys_icache_invalidate(data() + offset, size);
  if (!kSwitches && ::mprotect(data() + offset, size, PROT_READ | PROT_EXEC) != 0)
    refuse("the system refuses executable memory");
}

void Pages::forbid(std::size_t offset, std::size_t size) {
  if (::mprotect(data() + offset, size, PROT_NONE) != 0) refuse("the system refuses a guard page");
}

void discard_pages(void* first, std::size_t size) { ::madvise(first, size, MADV_FREE); }

void prefer_large_pages(void*, std::size_t) {}  // the system chooses them when memory is mapped
bool can_prefer_large_pages() { return false; }

}  // namespace racebeam
