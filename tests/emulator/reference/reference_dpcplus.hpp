// A model of DPC+, written only from docs/spec/cartridges.md, 14, and one program for its ARM, which the
// model does without an ARM. It uses nothing of emulator/.
#pragma once

#include <algorithm>

#include "tests/emulator/reference/reference_cartridges.hpp"
#include "tests/support/thumb_code.hpp"

namespace racebeam::test {

// A call increments byte 0 of the display data, and adds it to byte 1. If byte 0 has become 200, the call
// never ends.
inline void put_counting_program(Image& image) {
  using namespace thumb;
  put(image, image.size() - 29696 + 8,
      {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, 0x0C), lsl(2, 2, 8), add(1, 1, 2),  // $40000C00
       ldrb(2, 1, 0), add_number(2, 1), strb(2, 1, 0), cmp_number(2, 200), branch_if(kEq, 0), ldrb(3, 1, 1),
       add(3, 3, 2), strb(3, 1, 1), bx(kLr)});
}

// Instructions as fast fetch sees them.
inline unsigned length_of(unsigned opcode) {
  const unsigned low = opcode & 0x0F;
  const bool odd = (opcode & 0x10) != 0;
  if (low >= 0x0C || (odd && (low == 0x09 || low == 0x0B))) return 3;
  if (low == 0x08 || low == 0x0A || opcode == 0x00 || opcode == 0x40 || opcode == 0x60) return 1;
  return low == 0x02 && (odd || opcode < 0x80) ? 1 : 2;
}

inline bool is_jump(unsigned opcode) { return opcode == 0x4C || opcode == 0x6C || opcode % 32 == 0x10; }

// Whether the byte at `a` is the third one of JSR. The last byte was in front of `next`, in an instruction
// with `opcode`. `before` is the byte two addresses in front.
inline bool ends_call(unsigned a, unsigned next, unsigned opcode, unsigned before) {
  return a == next ? opcode == 0x20 : before == 0x20 && !is_jump(opcode);
}

struct ModelDpcPlus : Copyable<ModelDpcPlus> {
  explicit ModelDpcPlus(Image bytes) : Copyable(std::move(bytes)), base(image.size() - 29696) {
    for (std::size_t i = 0; i < 4096; ++i) display[i] = image[base + 24576 + i];
  }
  std::size_t base;
  std::array<unsigned, 4096> display{};
  std::array<unsigned, 8> pointer{}, top{}, bottom{}, fractional{}, fraction{}, step{}, parameter{};
  std::array<unsigned, 3> waveform{};
  std::array<std::uint32_t, 3> frequency{}, phase{};
  std::uint32_t random = 0x2B435044;
  unsigned bank = 5, parameters = 0;
  bool fast = false, waits = false, stands = false;
  unsigned next = 0, rest = 0, opcode = 0;
  std::int64_t counted = 0;  // cycles

  void arm() {
    waits = false;
    display[0] = (display[0] + 1) % 256;
    if (display[0] == 200)
      stands = true;
    else
      display[1] = (display[1] + display[0]) % 256;
  }

  static std::int64_t samples_at(std::int64_t cycles) { return cycles * 3 * 20000 / 3579575; }

  void pass(int cycle) {
    const auto samples = static_cast<std::uint32_t>(samples_at(cycle) - samples_at(counted));
    for (std::size_t v = 0; v < 3; ++v) phase[v] += samples * frequency[v];
    counted = cycle;
  }

  bool inside(unsigned i) const {
    const unsigned low = pointer[i] % 256;
    if (top[i] == bottom[i]) return low != top[i];
    for (unsigned place = (top[i] + 1) % 256; place != bottom[i]; place = (place + 1) % 256)
      if (place == low) return true;
    return false;
  }

  unsigned fetch(unsigned i) {
    const unsigned value = display[pointer[i]];
    pointer[i] = (pointer[i] + 1) % 4096;
    return value;
  }

  unsigned number(unsigned i, int cycle) {
    constexpr std::uint32_t kTaps = 0x10ADAB1E;
    if (i == 0) {
      random = random >> 11 | random << 21;
      if (random & 0x80000000) random ^= kTaps;
      return random & 0xFF;
    }
    if (i == 1) {
      if (random & 0x80000000) random ^= kTaps;
      random = random << 11 | random >> 21;
      return random & 0xFF;
    }
    if (i <= 4) return random >> (8 * (i - 1)) & 0xFF;
    if (i >= 6) return 0;
    pass(cycle);
    unsigned sum = 0;
    for (std::size_t v = 0; v < 3; ++v) sum += display[32 * waveform[v] + (phase[v] >> 27)];
    return sum % 256;
  }

  unsigned reg(unsigned offset, int cycle) {
    const unsigned i = offset % 8;
    if (offset < 0x08) return number(i, cycle);
    if (offset < 0x10) return fetch(i);
    if (offset < 0x18) return inside(i) ? fetch(i) : fetch(i) * 0;
    if (offset >= 0x20) return i < 4 && inside(i) ? 0xFF : 0;
    const unsigned value = display[fractional[i]];
    fraction[i] += step[i];
    fractional[i] = (fractional[i] + fraction[i] / 256) % 4096;
    fraction[i] %= 256;
    return value;
  }

  void touch(unsigned a) {
    if (a >= 0x1FF6 && a <= 0x1FFB) bank = a - 0x1FF6;
  }

  unsigned read(unsigned a, int cycle) override {
    if (waits) {
      pass(cycle);
      arm();
    }
    touch(a);
    const auto in_bank = [&](unsigned place) { return image[base + 4096 * bank + (place & 0xFFF)]; };
    const unsigned value = a < 0x1028 ? reg(a - 0x1000, cycle) : in_bank(a);
    if (!fast) return value;
    if (rest > 0 && a == next) {
      next = (a + 1) & 0x1FFF;
      --rest;
      return opcode == 0xA9 && value < 0x28 ? reg(value, cycle) : value;
    }
    const bool ends = ends_call(a, next, opcode, in_bank(a - 2));
    rest = ends ? 0 : length_of(value) - 1;
    opcode = ends ? 0xEA : value;
    next = (a + 1) & 0x1FFF;
    return value;
  }

  void call(unsigned function) {
    if (function == 1 || function == 2) {
      for (unsigned i = 0; i < parameter[3]; ++i) {
        const unsigned from = (parameter[0] + 256 * parameter[1] + i) % 29696;
        display[(pointer[parameter[2] % 8] + i) % 4096] = function == 1 ? image[base + from] : parameter[0];
      }
    }
    if (function <= 2) parameters = 0;
    if (function >= 254) waits = !stands;
  }

  void control(unsigned i, unsigned v) {
    if (i == 0) {
      fast = v == 0;
      next = rest = opcode = 0;
    } else if (i == 1 && parameters < 8) {
      parameter[parameters++] = v;
    } else if (i == 2) {
      call(v);
    } else if (i >= 5) {
      waveform[i - 5] = v % 128;
    }
  }

  void set_number(unsigned i, unsigned v) {
    if (i == 0) random = 0x2B435044;
    if (i >= 1 && i <= 4) random = (random & ~(0xFFU << (8 * (i - 1)))) | v << (8 * (i - 1));
    if (i < 5) return;
    const std::size_t word = image.size() - 1024 + 4 * v;
    frequency[i - 5] = 0;
    for (unsigned byte = 4; byte-- > 0;) frequency[i - 5] = frequency[i - 5] << 8 | image[word + byte];
  }

  void write(unsigned a, unsigned v) override {
    if (waits) arm();
    touch(a);
    const unsigned i = a % 8;
    if (a >= 0x1028 && a <= 0x102F) fractional[i] = fractional[i] / 256 * 256 + v, fraction[i] = 0;
    if (a >= 0x1030 && a <= 0x1037) fractional[i] = v % 16 * 256 + fractional[i] % 256;
    if (a >= 0x1038 && a <= 0x103F) step[i] = v, fraction[i] = 0;
    if (a >= 0x1040 && a <= 0x1047) top[i] = v;
    if (a >= 0x1048 && a <= 0x104F) bottom[i] = v;
    if (a >= 0x1050 && a <= 0x1057) pointer[i] = pointer[i] / 256 * 256 + v;
    if (a >= 0x1058 && a <= 0x105F) control(i, v);
    if (a >= 0x1060 && a <= 0x1067) pointer[i] = (pointer[i] + 4095) % 4096, display[pointer[i]] = v;
    if (a >= 0x1068 && a <= 0x106F) pointer[i] = v % 16 * 256 + pointer[i] % 256;
    if (a >= 0x1070 && a <= 0x1077) set_number(i, v);
    if (a >= 0x1078 && a <= 0x107F) display[pointer[i]] = v, pointer[i] = (pointer[i] + 1) % 4096;
  }
};

}  // namespace racebeam::test
