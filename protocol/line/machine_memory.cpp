#include "protocol/line/machine_memory.hpp"

#include "emulator/tia/line_cache/line_record.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kMachine = std::size_t{14} << 10;  // without pictures and lines, measured

}  // namespace

void MachineMemory::release_caches(Slot& slot) {
  slot.environment().release_caches();
  rested_ = frame_of(slot);
}

std::size_t MachineMemory::held(const Slot& slot) const {
  const auto rows = static_cast<std::size_t>(slot.environment().height());
  const bool played = frame_of(slot) != first_frame_;
  const bool rested = frame_of(slot) == rested_;
  const std::size_t pictures =
      played ? (slot.environment().drawing() == Drawing::kNone ? 1 : 2) : (rested ? 0 : 1);
  std::size_t bytes = kMachine + pictures * rows * (kScreenWidth + sizeof(LineNumber));
  if (!rested) bytes += rows * sizeof(LineRecord);
  if (const ScreenStack* const stack = slot.stack()) {
    const auto channels = static_cast<std::size_t>(stack->settings().channels());
    bytes += stack->size() + channels * (rows * kScreenWidth + stack->screen_size()) +
             rows * ScreenStack::kBytesOfRow;
  }
  return bytes;
}

}  // namespace racebeam
