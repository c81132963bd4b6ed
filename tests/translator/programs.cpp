// translator_programs FIRST COUNT [STEPS]: runs that many random programs, from seed FIRST on, on the
// interpreter and on the translator, and prints differences. Ends with status 1 if there are any.
#include <cstdio>
#include <cstdlib>

#include "tests/translator/pair.hpp"

namespace {

// Every kSeldom programs, one runs for this many steps with --cpu auto, which begins to translate after a
// while.
constexpr std::uint32_t kSeldom = 20;
constexpr int kLong = 60;

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: translator_programs FIRST COUNT [STEPS]\n", stderr);
    return 2;
  }
  const auto first = static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10));
  const auto count = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
  const int steps = argc > 3 ? std::atoi(argv[3]) : 3;
  unsigned different = 0;
  for (std::uint32_t seed = first; seed != first + count; ++seed) {
    std::string found = racebeam::test::difference_in_program(seed, steps);
    if (found.empty() && seed % kSeldom == 0)
      found = racebeam::test::difference_in_program(seed, kLong, racebeam::CpuKind::kAuto);
    if (found.empty()) continue;
    ++different;
    std::puts(found.c_str());
    std::fflush(stdout);
  }
  std::printf("%u programs from %u, %d steps each: %u different\n", count, first, steps, different);
  return different == 0 ? 0 : 1;
}
