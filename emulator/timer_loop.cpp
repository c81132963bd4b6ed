#include "emulator/timer_loop.hpp"

namespace racebeam {
namespace {

enum Opcode : std::uint8_t {
  kBpl = 0x10, kBmi = 0x30, kBne = 0xD0, kBitAbsolute = 0x2C, kLdyAbsolute = 0xAC, kLdaAbsolute = 0xAD, kLdxAbsolute = 0xAE
};

enum class TimerRegister { kNone, kIntim, kInstat };

TimerRegister register_at(unsigned address) {
  if ((address & 0x1284) != 0x0284) return TimerRegister::kNone;
  return address & 1 ? TimerRegister::kInstat : TimerRegister::kIntim;
}

// The loop goes on while more than this many intervals are left, as INTIM counts them; -1: until the timer has run
// out; -2: no such loop.
int last_count(const std::uint8_t* branch) {
  const std::uint8_t reads = branch[-3];
  const TimerRegister reg = register_at(static_cast<unsigned>(branch[-2] | branch[-1] << 8));
  const bool loads = reads == kLdaAbsolute || reads == kLdxAbsolute || reads == kLdyAbsolute;
  if (reg == TimerRegister::kIntim && loads) {
    if (*branch == kBne) return 0;
    if (*branch == kBpl) return -1;
    if (*branch == kBmi) return 127;
  }
  if (reg == TimerRegister::kInstat && (loads || reads == kBitAbsolute) && *branch == kBpl) return -1;
  return -2;
}

}  // namespace

std::int32_t sure_timer_turns(const std::uint8_t* branch, const RiotState& riot, std::int32_t next_read,
                              std::int32_t period) {
  const int last = last_count(branch);
  if (last < -1) return 0;
  // INTIM is timer - 1 - (elapsed >> shift), see riot.hpp: it exceeds `last` for so many cycles.
  const std::int64_t elapsed = static_cast<std::uint32_t>(next_read - 1 - static_cast<std::int32_t>(riot.timer_set));
  const std::int64_t lasts = static_cast<std::int64_t>(riot.timer - 1 - last) * (std::int64_t{1} << riot.shift);
  return elapsed >= lasts ? 0 : static_cast<std::int32_t>((lasts - elapsed + period - 1) / period);
}

}  // namespace racebeam
