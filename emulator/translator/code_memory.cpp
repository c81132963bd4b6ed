#include "emulator/translator/code_memory.hpp"

namespace racebeam::translator {

CodeMemory::CodeMemory(std::size_t size) : pages_(size, Pages::Use::kCode) {}

std::size_t CodeMemory::seal(std::size_t size) {
  size = whole_pages(size);
  pages_.make_executable(used_, size);
  used_ += size;
  return size;
}

}  // namespace racebeam::translator
