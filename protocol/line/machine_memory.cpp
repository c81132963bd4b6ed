#include "protocol/line/machine_memory.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kMachine = std::size_t{14} << 10;  // what is the same for all machines, measured

// The stack, and the picture that it takes in.
std::size_t stack_memory(const ScreenStack& stack, std::size_t rows) {
  const auto channels = static_cast<std::size_t>(stack.settings().channels());
  return stack.size() + channels * (rows * kScreenWidth + stack.screen_size()) +
         rows * ScreenStack::kBytesOfRow;
}

}  // namespace

std::size_t machine_memory(const Slot& slot) {
  const Environment& machine = slot.environment();
  const auto rows = static_cast<std::size_t>(machine.height());
  return kMachine + machine.footprint() + (slot.stack() ? stack_memory(*slot.stack(), rows) : 0);
}

}  // namespace racebeam
