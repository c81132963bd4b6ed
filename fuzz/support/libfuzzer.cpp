// Runs a target under libFuzzer (preset `fuzz`). At the end it reports the number and size of inputs, which
// libFuzzer does not.
#include <cstdio>
#include <cstdlib>

#include "fuzz/support/target.hpp"

namespace {

std::size_t inputs = 0, bytes = 0;

void tell() { std::fprintf(stderr, "fuzz: %zu inputs, %zu bytes\n", inputs, bytes); }

}  // namespace

// libFuzzer defines the name and the types.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (inputs++ == 0) std::atexit(tell);
  bytes += size;
  racebeam::fuzz::run({data, size});
  return 0;
}
