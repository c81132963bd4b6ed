#include "emulator/translator/code_memory.hpp"

namespace racebeam::translator {

CodeMemory::CodeMemory(std::size_t size) : pages_(size) {}

std::size_t CodeMemory::seal(std::size_t size) {
  size = whole_pages(size);
  // Processors other than x86-64 may still have the bytes before these in their caches of instructions.
  __builtin___clear_cache(reinterpret_cast<char*>(pages_.data() + used_),
                          reinterpret_cast<char*>(pages_.data() + used_ + size));
  pages_.make_executable(used_, size);
  used_ += size;
  return size;
}

}  // namespace racebeam::translator
