#include "emulator/translator/code_memory.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace racebeam::translator {
namespace {

std::size_t whole_pages(std::size_t size) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return (size + page - 1) / page * page;
}

[[noreturn]] void refuse(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

CodeMemory::CodeMemory(std::size_t size) : size_(whole_pages(size)) {
  void* memory =
      mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) refuse("cannot allocate memory for translated code");
  base_ = static_cast<char*>(memory);
  open_ = size_;
}

CodeMemory::~CodeMemory() { munmap(base_, size_); }

std::size_t CodeMemory::seal(std::size_t size) {
  size = whole_pages(size);
  if (mprotect(base_ + used_, size, PROT_READ | PROT_EXEC) != 0)
    refuse("the system refuses executable memory");
  used_ += size;
  return size;
}

}  // namespace racebeam::translator
