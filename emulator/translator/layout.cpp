#include "emulator/translator/layout.hpp"

#include "emulator/board/board_memory.hpp"
#include "emulator/cartridge/mappers/dpc.hpp"

namespace racebeam::translator {

Layout::Layout(const BoardMemory& board) {
  const auto at = [&board](const auto& member) {
    return static_cast<std::int32_t>(reinterpret_cast<const char*>(&member) -
                                     reinterpret_cast<const char*>(&board));
  };
  const State& state = board.state;
  ram = at(state.riot.ram);
  a = at(state.cpu.A);
  x = at(state.cpu.X);
  y = at(state.cpu.Y);
  sp = at(state.cpu.SP);
  cycle = at(state.cycle);
  pages = at(board.map.page);
  stop = at(board.stop);
  code = at(board.code.memory);
  code_span = at(board.code.span);
  last_access = at(board.last_access);
  slot = at(board.slot);
  sound = at(board.sound.registers);
  pins = at(board.pin_high_from);
  cartridge_ram = at(state.cartridge.ram);
  limit = at(board.translator_context.limit);
  first_line = at(board.translator_context.first_line);
  waited = at(board.translator_context.waited);
  nz = at(board.translator_context.nz);
  carry = at(board.translator_context.carry);
  overflow = at(board.translator_context.V);
  decimal = at(board.translator_context.D);
  interrupt = at(board.translator_context.I);
}

std::int32_t Layout::in_fetcher(std::uint16_t address, std::size_t member) const {
  return in_chip(offsetof(dpc::Chip, fetcher) + (address & 7) * sizeof(dpc::Fetcher) + member);
}

}  // namespace racebeam::translator
