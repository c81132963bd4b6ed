#include "emulator/cpu/timer_loop.hpp"

namespace racebeam {
namespace {

enum : std::uint8_t {  // opcodes
  kBpl = 0x10,
  kBmi = 0x30,
  kBne = 0xD0,
  kBitAbsolute = 0x2C,
  kLdyAbsolute = 0xAC,
  kLdaAbsolute = 0xAD,
  kLdxAbsolute = 0xAE
};

enum class TimerRegister { kNone, kIntim, kInstat };

TimerRegister register_at(unsigned address) {
  if ((address & 0x1284) != 0x0284) return TimerRegister::kNone;
  return address & 1 ? TimerRegister::kInstat : TimerRegister::kIntim;
}

// The loop continues while the intervals left, as INTIM counts them, are in [least, most].
struct Range {
  int least, most;
};
constexpr Range kNoLoop = {1, 0};

Range looping_counts(const std::uint8_t* branch) {
  const std::uint8_t reads = branch[-3];
  const TimerRegister reg = register_at(static_cast<unsigned>(branch[-2] | branch[-1] << 8));
  const bool loads = reads == kLdaAbsolute || reads == kLdxAbsolute || reads == kLdyAbsolute;
  if (reg == TimerRegister::kIntim && loads) {
    if (*branch == kBne) return {1, 255};
    if (*branch == kBpl) return {0, 127};
    if (*branch == kBmi) return {128, 255};
  }
  if (reg == TimerRegister::kInstat && (loads || reads == kBitAbsolute) && *branch == kBpl) return {0, 255};
  return kNoLoop;
}

}  // namespace

std::int32_t sure_timer_turns(const std::uint8_t* branch, const RiotState& riot, std::int32_t next_read,
                              std::int32_t period) {
  const Range range = looping_counts(branch);
  const std::int64_t elapsed = static_cast<std::uint32_t>(next_read) - 1 - riot.timer_set;
  const std::int64_t count = riot.timer - 1 - (elapsed >> riot.shift);  // as in riot.hpp
  if (count < range.least || count > range.most) return 0;
  const std::int64_t ends = std::int64_t{riot.timer - range.least} << riot.shift;
  return static_cast<std::int32_t>((ends - elapsed + period - 1) / period);
}

bool is_timer_loop(const std::uint8_t* branch) {
  const Range range = looping_counts(branch);
  return range.least <= range.most;
}

}  // namespace racebeam
