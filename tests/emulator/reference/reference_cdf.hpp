// A model of CDFJ and CDFJ+, written only from docs/spec/cartridges.md, 15, and one program for their ARM,
// which the model does without an ARM. It uses nothing of emulator/.
#pragma once

#include <algorithm>

#include "tests/emulator/reference/reference_dpcplus.hpp"

namespace racebeam::test {

// A call increments byte 0 of the display data, adds it to byte 1, makes it the frequency of voice 0, times
// 2^24, and the increment of stream 5, and resets the phase of voice 1. If byte 0 has become 200, the call
// never ends.
inline void put_counting_cdf_program(Image& image, bool is_plus) {
  using namespace thumb;
  const unsigned entry = is_plus ? 0x7800 : 0x808;
  put(image, entry,
      {mov_any(7, kLr),
       mov_number(1, 1),
       lsl(1, 1, 30),
       mov_number(2, 0x8),
       lsl(2, 2, 8),
       add(5, 1, 2),  // $40000800
       ldrb(6, 5, 0),
       add_number(6, 1),
       strb(6, 5, 0),
       cmp_number(6, 200),
       branch_if(kEq, 0),
       ldrb(3, 5, 1),
       add(3, 3, 6),
       strb(3, 5, 1),
       mov_number(2, 0x138 / 4),
       lsl(2, 2, 2),
       add(1, 1, 2),
       str(6, 1, 0),  // increment 5
       mov_number(2, 0),
       lsl(3, 6, 24),
       mov_number(4, 0x75),
       lsl(4, 4, 4),
       add_number(4, 1),  // $751, as the makers' header has it: BX to $750 would end the call
       mov_any(kLr, kPc),
       bx(4),
       mov_number(2, 1),
       add_number(4, 4),
       mov_any(kLr, kPc),
       bx(4),
       bx(7)});
  if (!is_plus) return;
  const std::uint8_t words[] = {0xDC, 0x1F, 0, 0x40, 0x01, 0x78, 0, 0};  // the stack, and the entry
  std::copy(std::begin(words), std::end(words), image.begin() + 0x17F4);
}

template <bool kPlus>
struct ModelCdf : Copyable<ModelCdf<kPlus>> {
  explicit ModelCdf(Image bytes) : Copyable<ModelCdf>(std::move(bytes)) {
    for (unsigned i = 0; i < 35; ++i) {
      pointer[i] = driver_word(0x98 + 4 * i);
      increment[i] = driver_word(0x124 + 4 * i);
    }
    for (unsigned v = 0; v < 3; ++v) waveform[v] = driver_word(0x1B0 + 4 * v);
  }
  using CartridgeModel::image;
  std::array<unsigned, 8192 - 2048> display{};
  std::array<std::uint32_t, 35> pointer{}, increment{};
  std::array<std::uint32_t, 3> waveform{}, frequency{}, phase{};
  unsigned bank = kPlus ? 0 : 6;
  bool fast = false, waves = false, waits = false, stands = false;
  unsigned next = 0, rest = 0, opcode = 0, jump = 0;
  std::int64_t counted = 0;

  static constexpr unsigned kFraction = kPlus ? 16 : 20;

  std::uint32_t driver_word(unsigned at) const {
    return image[at] | image[at + 1] << 8U | image[at + 2] << 16U | std::uint32_t{image[at + 3]} << 24U;
  }

  void arm() {
    waits = false;
    display[0] = (display[0] + 1) % 256;
    if (display[0] == 200) {
      stands = true;
      return;
    }
    display[1] = (display[1] + display[0]) % 256;
    increment[5] = display[0];
    frequency[0] = std::uint32_t{display[0]} << 24;
    phase[1] = 0;
  }

  static std::int64_t samples_at(std::int64_t cycles) { return cycles * 3 * 20000 / 3579575; }

  void pass(int cycle) {
    const auto samples = static_cast<std::uint32_t>(samples_at(cycle) - samples_at(counted));
    for (std::size_t v = 0; v < 3; ++v) phase[v] += samples * frequency[v];
    counted = cycle;
  }

  // A byte of the ARM's memory.
  unsigned byte_at(std::uint32_t place) const {
    if (place < image.size()) return image[place];
    if (place >= 0x40000800 && place < 0x40002000) return display[place - 0x40000800];
    if (place >= 0x400001B0 && place < 0x400001BC)
      return waveform[(place - 0x400001B0) / 4] >> (8 * (place % 4)) & 0xFF;
    if (place >= 0x40000124 && place < 0x400001B0)
      return increment[(place - 0x40000124) / 4] >> (8 * (place % 4)) & 0xFF;
    if (place >= 0x40000098 && place < 0x40000124)
      return pointer[(place - 0x40000098) / 4] >> (8 * (place % 4)) & 0xFF;
    return place >= 0x40000000 && place < 0x40000800 ? image[place - 0x40000000] : 0;
  }

  unsigned amplitude(int cycle) {
    pass(cycle);
    if (waves) {
      unsigned sum = 0;
      for (std::size_t v = 0; v < 3; ++v) sum += byte_at(waveform[v] + (phase[v] >> 27));
      return sum % 256;
    }
    const std::uint32_t nibble = phase[0] >> (kPlus ? 12 : 20);
    const unsigned pair = byte_at(waveform[0] + nibble / 2);
    return nibble % 2 == 0 ? pair / 16 : pair % 16;
  }

  unsigned stream(unsigned i) {
    const std::uint32_t place = pointer[i] >> kFraction;
    pointer[i] += increment[i] << (kFraction - 8);
    return place < display.size() ? display[place] : 0;
  }

  bool loads() const {
    if (opcode == 0xA9) return true;
    return kPlus && ((opcode == 0xA2 && image[0x34C] == 0xA2) || (opcode == 0xA0 && image[0x350] == 0xA0));
  }

  unsigned loaded(unsigned value, int cycle) {
    const unsigned first = kPlus && image[0x3E0] <= 220 ? image[0x3E0] : 0;
    if (value < first || value > first + 35) return value;
    return value == first + 35 ? amplitude(cycle) : stream(value - first);
  }

  void touch(unsigned a) {
    const unsigned first = kPlus ? 0x1FF4 : 0x1FF5;
    if (a >= first && a < first + 7) bank = a - first;
  }

  unsigned byte_of_bank(unsigned a) const {
    return image[(kPlus ? 0x800 : 0x1000) + 4096 * bank + (a & 0xFFF)];
  }

  unsigned read(unsigned a, int cycle) override {
    if (waits) {
      pass(cycle);
      arm();
    }
    touch(a);
    const unsigned value = byte_of_bank(a);
    if (!fast) return value;
    const bool continued = rest > 0 && a == next, ends = ends_call(a, next, opcode, byte_of_bank(a - 2));
    next = (a + 1) & 0x1FFF;
    if (!continued) {
      opcode = ends ? 0xEA : value;
      rest = ends ? 0 : length_of(value) - 1;
      jump = 0;
      return value;
    }
    --rest;
    if (loads()) return loaded(value, cycle);
    if (opcode != 0x4C) return value;
    if (rest == 0) return jump != 0 ? stream(jump) : value;
    if (value > 1 || byte_of_bank(a + 1) != 0) return value;
    jump = 33 + value;
    return stream(jump);
  }

  void write(unsigned a, unsigned v) override {
    if (waits) arm();
    touch(a);
    const std::uint32_t place = pointer[32] >> kFraction;
    if (a == 0x1FF0) {
      if (place < display.size()) display[place] = v;
      pointer[32] += 1U << kFraction;
    }
    if (a == 0x1FF1) pointer[32] = (place * 256 + v) << kFraction;
    if (a == 0x1FF2) fast = v % 16 == 0, waves = v / 16 != 0, next = rest = opcode = jump = 0;
    if (a == 0x1FF3 && v >= 254) waits = !stands;
  }
};

}  // namespace racebeam::test
