// What the CPU sees at each address, as far as it is plain memory: 256 pages of 64 bytes, for address bits 13 to 6.
// (Bit 13 counts because FE cartridges decode it.) A page without memory is a device: TIA, RIOT or a hot spot.
#pragma once

#include <array>
#include <cstdint>

namespace racebeam {

struct MemoryMap {
  static constexpr int kPageSize = 64;

  std::array<const std::uint8_t*, 256> page{};

  const std::uint8_t* page_of(std::uint16_t address) const { return page[address >> 6 & 0xFF]; }

  // Shows `memory` from cartridge address `from` (0-$FFF) on, for `size` bytes, whatever bits 13 and 15-14 are.
  void show(unsigned from, const std::uint8_t* memory, unsigned size) {
    for (unsigned offset = 0; offset < size; offset += kPageSize) {
      page[(0x1000 + from + offset) >> 6] = memory + offset;
      page[(0x3000 + from + offset) >> 6] = memory + offset;
    }
  }

  // Addresses of the cartridge that do something when they are touched.
  void hide(unsigned from, unsigned size) {
    for (unsigned offset = 0; offset < size; offset += kPageSize)
      page[(0x1000 + from + offset) >> 6] = page[(0x3000 + from + offset) >> 6] = nullptr;
  }
};

}  // namespace racebeam
