#include "system/resources.hpp"

#include <emscripten/heap.h>
#include <fcntl.h>

namespace racebeam {

Allowance usable_processors(const std::string&) { return {1, "the machine"}; }

Allowance usable_memory(const std::string&) {
  constexpr std::uint64_t kMax = std::uint64_t{1} << 31;  // Emscripten's MAXIMUM_MEMORY
  return {kMax, "the address space"};
}

std::uint64_t usable_files() {
  constexpr std::uint64_t kMax = 4096;  // Emscripten's limit
  return kMax;
}

void set_thread_stacks() {}  // there is only one thread

std::uint64_t open_files(std::uint64_t most) {
  std::uint64_t open = 0;
  for (std::uint64_t file = 0; file < most; ++file) open += ::fcntl(static_cast<int>(file), F_GETFD) != -1;
  return open;
}

std::uint64_t resident_memory() { return emscripten_get_heap_size(); }

}  // namespace racebeam
