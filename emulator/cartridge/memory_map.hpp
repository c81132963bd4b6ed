// What the CPU sees at each address, as far as it is plain memory: 256 pages of 64 bytes, for address bits 13
// to 6. (Bit 13 counts because FE cartridges decode it.) A page without memory is a device: TIA, RIOT or a
// hot spot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace racebeam {

// Memory with instructions: `memory` shows the addresses from `first` on. `span` addresses can start an
// instruction, because two more bytes follow them.
struct CodeWindow {
  const std::uint8_t* memory = nullptr;
  std::uint16_t first = 0;
  std::uint16_t span = 0;
  const std::uint8_t* end = memory + span;

  // Forgets what the window shows, but not where it is.
  void close() {
    span = 0;
    end = nullptr;
  }
};

struct MemoryMap {
  static constexpr int kPageSize = 64;
  static constexpr unsigned kLastPage = 0x7F;  // of the cartridge; bit 13 selects a second one

  std::array<const std::uint8_t*, 256> page{};

  // Bytes of the cartridge's last page before its first hot spot. They may hold code, too.
  std::uint16_t quiet_tail = 0;

  const std::uint8_t* page_of(std::uint16_t address) const { return page[address >> 6 & 0xFF]; }

  // The longest run of contiguous memory around an address that may hold code.
  CodeWindow window_around(std::uint16_t address) const {
    unsigned low = address >> 6 & 0xFF;
    if (page[low] == nullptr) --low;
    unsigned high = low;
    while ((low & 0x3F) != 0 && page[low - 1] != nullptr && page[low - 1] + kPageSize == page[low]) --low;
    while ((high & 0x3F) != 0x3F && page[high + 1] == page[high] + kPageSize) ++high;
    const auto first = static_cast<std::uint16_t>((address & 0xC000) | low << 6);
    const unsigned tail = (high & 0x7F) == kLastPage - 1 && page[high + 1] == nullptr ? quiet_tail : 0U;
    return {page[low], first, static_cast<std::uint16_t>((high - low + 1) * kPageSize + tail - 2)};
  }

  // Whether the address is in plain memory, or in the quiet tail after it.
  bool may_hold_code(std::uint16_t address) const {
    if (page_of(address) != nullptr) return true;
    const bool last = (address >> 6 & 0x7F) == kLastPage;
    return last && (address & 0x3F) < quiet_tail &&
           page_of(static_cast<std::uint16_t>(address - kPageSize)) != nullptr;
  }

  // Maps `memory`, `size` bytes of it, from cartridge address `from` (0-$FFF) on, for all values of bits 13,
  // 14 and 15. Some games switch banks dozens of times a frame; GCC makes no vectors of pointers.
  void show(unsigned from, const std::uint8_t* memory, unsigned size) {
    const std::uint8_t** const low = &page[(0x1000 + from) / kPageSize];
    const std::uint8_t** const high = &page[(0x3000 + from) / kPageSize];
    const std::size_t count = (size + kPageSize - 1) / kPageSize;
#pragma GCC unroll 8
    for (std::size_t i = 0; i < count; ++i) low[i] = high[i] = memory + i * kPageSize;
  }

  // Hides pages whose addresses have an effect when they are accessed. In the last page, the first `quiet`
  // bytes have no effect, and continue the image.
  void hide(unsigned from, unsigned size, unsigned quiet = 0) {
    quiet_tail = static_cast<std::uint16_t>(quiet);
    for (unsigned offset = 0; offset < size; offset += kPageSize)
      page[(0x1000 + from + offset) >> 6] = page[(0x3000 + from + offset) >> 6] = nullptr;
  }
};

}  // namespace racebeam
