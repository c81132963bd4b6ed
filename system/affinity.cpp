#include "system/affinity.hpp"

#include <sched.h>

#include <cstddef>
#include <memory>

namespace racebeam {

// The system refuses a set for too few processors, so larger ones are tried.
std::vector<unsigned> allowed_processors() {
  std::vector<unsigned> processors;
  for (std::size_t most = CPU_SETSIZE; processors.empty() && most <= 1 << 20; most *= 2) {
    const auto free_set = [](cpu_set_t* set) { CPU_FREE(set); };
    const std::unique_ptr<cpu_set_t, decltype(free_set)> set(CPU_ALLOC(most), free_set);
    const std::size_t size = CPU_ALLOC_SIZE(most);
    if (::sched_getaffinity(0, size, set.get()) != 0) continue;
    for (unsigned number = 0; number < most; ++number)
      if (CPU_ISSET_S(number, size, set.get())) processors.push_back(number);
  }
  return processors;
}

}  // namespace racebeam
