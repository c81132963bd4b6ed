#include "emulator/base/stopwatch.hpp"

#include "system/clock.hpp"

namespace racebeam {
namespace {

constexpr Clocks kHostClocks{wall_time, processor_time};

}  // namespace

const Clocks& host_clocks() { return kHostClocks; }

}  // namespace racebeam
