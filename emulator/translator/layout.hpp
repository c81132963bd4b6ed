#pragma once

#include <cstddef>
#include <cstdint>

namespace racebeam {
struct BoardMemory;
}

namespace racebeam::translator {

// Offsets in bytes from the start of a BoardMemory, which is also that of its Board, to the fields that
// translated code uses. They are the same for all boards.
struct Layout {
  explicit Layout(const BoardMemory& board);

  std::int32_t ram, a, x, y, sp, cycle, pages, stop, code, code_span, last_access, slot, sound, pins;
  std::int32_t cartridge_ram, limit, first_line, waited, nz, carry, overflow, decimal, interrupt;

  // Offsets to members of the DPC's chip, and to members of the fetcher that an address selects.
  std::int32_t in_chip(std::size_t member) const { return cartridge_ram + static_cast<std::int32_t>(member); }
  std::int32_t in_fetcher(std::uint16_t address, std::size_t member) const;
};

}  // namespace racebeam::translator
