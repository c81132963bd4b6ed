#include "system/pages.hpp"

#include <windows.h>

#include <cxxabi.h>

#include <system_error>

namespace racebeam {
namespace {

[[noreturn]] void refuse(const char* what) {
  throw std::system_error(static_cast<int>(GetLastError()), std::system_category(), what);
}

bool protect(std::byte* first, std::size_t size, DWORD access) {
  DWORD before = 0;
  return VirtualProtect(first, size, access, &before) != 0;
}

// With MinGW, a thread that ends frees the memory of its thread_local variables by one key, and calls their
// destructors by another; the key that was made first goes first. This makes the key of destructors before
// any such variable is used.
[[gnu::constructor(101)]] void call_destructors_first() {
  abi::__cxa_thread_atexit([](void*) {}, nullptr, nullptr);
}

}  // namespace

// Pages are either writable or executable for all threads.
CodeWriting::CodeWriting() = default;
CodeWriting::~CodeWriting() = default;

std::size_t page_size() {
  SYSTEM_INFO info;
  GetSystemInfo(&info);
  return info.dwPageSize;
}

Pages::Pages(std::size_t size, Use) {
  size = whole_pages(size);
  void* const memory = VirtualAlloc(nullptr, size, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
  if (memory == nullptr) refuse("the system refuses memory");
  all_ = {static_cast<std::byte*>(memory), size};
}

Pages::~Pages() {
  if (!all_.empty()) VirtualFree(all_.data(), 0, MEM_RELEASE);
}

void Pages::make_executable(std::size_t offset, std::size_t size) {
  if (!protect(data() + offset, size, PAGE_EXECUTE_READ)) refuse("the system refuses executable memory");
}

void Pages::forbid(std::size_t offset, std::size_t size) {
  if (!protect(data() + offset, size, PAGE_NOACCESS)) refuse("the system refuses a guard page");
}

void discard_pages(void* first, std::size_t size) { VirtualAlloc(first, size, MEM_RESET, PAGE_READWRITE); }

void prefer_large_pages(void*, std::size_t) {}  // they require a privilege
bool can_prefer_large_pages() { return false; }

}  // namespace racebeam
