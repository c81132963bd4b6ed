// The memory of the ARM on a cartridge: flash memory, which ends at kFlashEnd or after a larger image, and
// RAM. All other addresses read as 0. Writes to them, and to the flash memory, do nothing
// (docs/spec/cartridges.md, 13).
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace racebeam::arm {

static_assert(std::endian::native == std::endian::little, "the ARM's numbers are copied byte by byte");

constexpr std::uint32_t kFlashEnd = 0x8000, kRamBegin = 0x40000000;

struct Memory {
  std::span<const std::uint8_t> flash;
  std::span<std::uint8_t> ram;
  std::uint32_t code_begin = 0;  // code in front of it is not executed
  std::uint32_t flash_begin =
      flash.size() < kFlashEnd ? kFlashEnd - static_cast<std::uint32_t>(flash.size()) : 0;

  // The bytes from `address` on; null unless `size` of them are in one of the two.
  const std::uint8_t* find(std::uint32_t address, std::size_t size) const {
    const std::uint32_t in_flash = address - flash_begin;
    if (in_flash + size <= flash.size()) return flash.data() + in_flash;
    return find_ram(address, size);
  }

  std::uint8_t* find_ram(std::uint32_t address, std::size_t size) const {
    const std::uint32_t in_ram = address - kRamBegin;
    return in_ram + size <= ram.size() ? ram.data() + in_ram : nullptr;
  }

  // The low bits of the address are ignored.
  template <class Number>
  Number load(std::uint32_t address) const {
    Number number = 0;
    if (const std::uint8_t* bytes = find(aligned<Number>(address), sizeof number))
      std::memcpy(&number, bytes, sizeof number);
    return number;
  }

  template <class Number>
  void store(std::uint32_t address, Number number) const {
    if (std::uint8_t* bytes = find_ram(aligned<Number>(address), sizeof number))
      std::memcpy(bytes, &number, sizeof number);
  }

 private:
  template <class Number>
  static constexpr std::uint32_t aligned(std::uint32_t address) {
    return address & ~static_cast<std::uint32_t>(sizeof(Number) - 1);
  }
};

}  // namespace racebeam::arm
