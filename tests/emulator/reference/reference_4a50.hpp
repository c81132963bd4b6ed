// A model of 4A50 and of the console's RAM, on the bus of the model of the 6507. Written only from
// docs/spec/cartridges.md, 16. It sees one access after the other, and uses nothing of emulator/.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/emulator/reference/reference_cpu.hpp"

namespace racebeam::test {

struct Model4a50 : Bus {
  explicit Model4a50(std::vector<std::uint8_t> bytes) : image(std::move(bytes)) {}

  struct Window {
    bool is_ram = false;
    int number = 0;
  };
  std::vector<std::uint8_t> image;
  std::vector<int> cartridge_ram = std::vector<int>(32768);
  std::array<int, 128> ram{};
  Window lower{false, 0}, middle{false, 16}, upper{false, 0};

  // What the hot spots of an instruction select takes effect when it has ended.
  void end_instruction() {
    for (const Seen& seen : seen_) select(seen);
    seen_.clear();
  }

  int cartridge_byte(int a) {
    const int* place = ram_at(a);
    return place != nullptr ? *place : image[rom_place(a)];
  }

 private:
  struct Seen {
    int address, value, before;
    bool writes, may_be_soft;
  };

  int read(int address, int) override {
    const int a = address & 0x1FFF;
    int value = 0;
    if ((a & 0x1080) == 0)  // the TIA, with no collision and released buttons
      value = (last_ & 0x3F) | ((a & 0xF) == 12 || (a & 0xF) == 13 ? 0x80 : 0);
    else if ((a & 0x1000) != 0)
      value = cartridge_byte(a);
    else if ((a & 0x1280) == 0x80)
      value = ram[static_cast<std::size_t>(a & 0x7F)];
    see(address, value, false);
    return value;
  }

  int write(int address, int value, int T, bool) override {
    const int a = address & 0x1FFF;
    if ((a & 0x1000) != 0) {
      if (int* place = ram_at(a)) *place = value;
    } else if ((a & 0x1280) == 0x80) {
      ram[static_cast<std::size_t>(a & 0x7F)] = value;
    }
    see(address, value, true);
    return T;
  }

  void see(int address, int value, bool writes) {
    seen_.push_back({address, value, last_, writes, !was_soft_});
    was_soft_ = (address & 0x1FFF) >= 0x400 && (address & 0x1FFF) < 0x1000;
    last_ = value;
  }

  int* ram_at(int a) {
    const int offset = a & 0xFFF;
    const auto in = [&](const Window& window, int size) {
      const int place = window.number % (32768 / size) * size + offset % size;
      return window.is_ram ? &cartridge_ram[static_cast<std::size_t>(place)] : nullptr;
    };
    if (offset < 0x800) return in(lower, 2048);
    if (offset < 0xE00) return in(middle, 2048);
    return offset < 0xF00 ? in(upper, 256) : nullptr;
  }
  std::size_t rom_place(int a) const {
    const int offset = a & 0xFFF;
    int place = 65536 - 256 + offset % 256;
    if (offset < 0x800)
      place = lower.number * 2048 + offset;
    else if (offset < 0xE00)
      place = middle.number * 2048 + offset % 2048;
    else if (offset < 0xF00)
      place = upper.number * 256 + offset % 256;
    return static_cast<std::size_t>(place);
  }

  void select(const Seen& seen) {
    select_by_value(seen);
    if (!seen.may_be_soft) return;
    const int page = seen.address >> 8, low = seen.address & 0xFF;
    if (page == seen.before) select_by_address(seen.before * 256 + low);
    if (page != seen.before + 1) return;
    // An index has led to the next page.
    select_by_address(seen.before * 256 + low);
    const int skipped = seen.before == 0x7E ? cartridge_byte(0x1E00 + low) : 0;
    if (skipped >= 0x60 && skipped < 0x80) select_by_address(seen.address);
  }

  void select_by_value(const Seen& seen) {
    int a = seen.address & 0x1FFF;
    if (seen.writes && a >= 0x74 && a <= 0x7F) a += 0x80;
    switch (a) {
      case 0xF4:
      case 0xF6:
      case 0xFC:
      case 0xFE: upper = {false, seen.value}; break;
      case 0xF5:
      case 0xF7:
      case 0xFD:
      case 0xFF: upper = {true, seen.value % 128}; break;
      case 0xF8:
      case 0xF9:
      case 0xFA:
      case 0xFB: {
        const bool is_ram = (seen.value & 0x40) != 0, is_middle = (seen.value & 0x80) != 0;
        const int number = seen.value % 16;
        if (is_middle)
          middle = {is_ram, is_ram ? number : 16 + number};
        else
          lower = {is_ram, number};
        break;
      }
      default: break;
    }
  }

  void select_by_address(int a) {
    const auto within = [&](int first, int last) { return a >= first && a <= last; };
    if (within(0x6400, 0x64FF)) lower.number ^= 1;
    if (within(0x6500, 0x65FF)) lower.number ^= 2;
    if (within(0x6800, 0x68FF)) middle.number ^= 1;
    if (within(0x6900, 0x69FF)) middle.number ^= 2;
    if (within(0x6C00, 0x6CFF)) upper = {false, a - 0x6C00};
    if (within(0x6D00, 0x6D7F)) upper = {true, a - 0x6D00};
    if (within(0x6E00, 0x6E0F)) lower = {false, a - 0x6E00};
    if (within(0x6E40, 0x6E4F)) lower = {true, a - 0x6E40};
    if (within(0x6F10, 0x6F1F)) middle = {false, a - 0x6F00};
    if (within(0x6F40, 0x6F4F)) middle = {true, a - 0x6F40};
    if (within(0x7F00, 0x7FFF)) {
      const int bit_a11 = a / 8 % 2, bits_a8_to_a10 = a / 16 % 8;
      upper.number = upper.number / 16 * 16 + bit_a11 * 8 + bits_a8_to_a10;
    }
  }

  std::vector<Seen> seen_;
  int last_ = 0;
  bool was_soft_ = false;
};

}  // namespace racebeam::test
