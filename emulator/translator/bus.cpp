#include "emulator/translator/bus.hpp"

#include "emulator/board/board.hpp"
#include "emulator/cpu/decimal.hpp"
#include "emulator/cpu/timer_loop.hpp"

namespace racebeam::translator::bus {

std::uint32_t RACEBEAM_SYSV_ABI read(Board* board, std::uint32_t address, std::uint32_t latch,
                                     std::int32_t cycle) {
  return board->read_device(static_cast<std::uint16_t>(address), static_cast<std::uint8_t>(latch), cycle);
}

std::int32_t RACEBEAM_SYSV_ABI write(Board* board, std::uint32_t address, std::uint32_t value,
                                     std::int32_t cycle) {
  const auto byte = static_cast<std::uint8_t>(value);
  board->state.cpu.latch = byte;
  if ((address & 0x1080) == 0 && board->is_plain_write(static_cast<std::uint16_t>(address), cycle)) {
    board->log->append_change(cycle, address & 0x3F, byte);
    return cycle;
  }
  return board->write_device(static_cast<std::uint16_t>(address), byte, cycle, true);
}

std::uint32_t RACEBEAM_SYSV_ABI pull(Board* board, std::int32_t cycle) {
  constexpr std::uint8_t kOpcode = 0x68;
  CpuState& cpu = board->state.cpu;
  const auto read_at = [&](std::uint8_t sp, std::uint8_t latch) {
    return sp & 0x80 ? board->state.riot.ram[sp & 0x7F]
                     : board->read_device(static_cast<std::uint16_t>(0x100 | sp), latch, cycle);
  };
  const std::uint8_t unused = read_at(cpu.SP, kOpcode);
  return read_at(++cpu.SP, unused);
}

std::uint32_t RACEBEAM_SYSV_ABI add_decimal(std::uint32_t a, std::uint32_t m, std::uint32_t carry,
                                            bool subtracts) {
  const auto left = static_cast<std::uint8_t>(a), right = static_cast<std::uint8_t>(m);
  const auto in = static_cast<std::uint8_t>(carry);
  const DecimalResult result =
      subtracts ? subtract_decimal(left, right, in) : racebeam::add_decimal(left, right, in);
  const unsigned overflow = ((left ^ result.value) & (result.value ^ right)) >> 7 & 1U;
  return overflow << 16 | unsigned{result.carry} << 8 | result.value;
}

std::int32_t RACEBEAM_SYSV_ABI skip_timer_loop(Board* board, const std::uint8_t* branch, std::int32_t cycle,
                                               std::int32_t period) {
  const std::int32_t skipped = period * sure_timer_turns(branch, board->state.riot, cycle + 4, period);
  board->translator_context.waited += static_cast<std::uint32_t>(skipped);
  return cycle + skipped;
}

#if defined(_WIN32)
std::uint32_t RACEBEAM_SYSV_ABI read_port(CartridgeSlot* slot, std::uint32_t address, std::int32_t cycle,
                                          PortReader reader) {
  return reader(*slot, static_cast<std::uint16_t>(address), cycle);
}
#endif

}  // namespace racebeam::translator::bus
