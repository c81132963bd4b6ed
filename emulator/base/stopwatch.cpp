#include "emulator/base/stopwatch.hpp"

#include <cstdlib>
#include <string>

#include "system/clock.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr Clocks kHostClocks{wall_time, processor_time};

}  // namespace

const Clocks& host_clocks() { return kHostClocks; }

bool policies_are_fixed() {
  const char* const value = std::getenv("RACEBEAM_POLICY");
  if (value == nullptr) return false;
  const std::string policy = value;
  if (policy == "fixed") return true;
  if (policy == "measured") return false;
  throw InvalidInput("RACEBEAM_POLICY is '" + policy + "'; accepted: fixed and measured");
}

}  // namespace racebeam
