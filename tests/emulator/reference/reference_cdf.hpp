// A model of CDF, CDFJ and CDFJ+, written only from docs/spec/cartridges.md, 15, and one program for their
// ARM, which the model does without an ARM. It uses nothing of emulator/.
#pragma once

#include <algorithm>

#include "tests/emulator/reference/reference_dpcplus.hpp"

namespace racebeam::test {

// A call increments byte 0 of the display data, adds it to byte 1, makes it the frequency of voice 0, times
// 2^24, and the increment of stream 5, and resets the phase of voice 1. If byte 0 has become 200, the call
// never ends.
// What the table of section 15 says of CDF0, CDF, CDFJ and CDFJ+, in this order.
struct CdfPlaces {
  unsigned pointers, increments, waveforms, functions, amplitude;
};
constexpr CdfPlaces kCdfPlaces[] = {{0x6E0, 0x768, 0x7F0, 0x6E0, 34},
                                    {0x0A0, 0x128, 0x1B0, 0x750, 34},
                                    {0x098, 0x124, 0x1B0, 0x750, 35},
                                    {0x098, 0x124, 0x1B0, 0x750, 35}};

inline void put_counting_cdf_program(Image& image, unsigned version) {
  using namespace thumb;
  const bool is_plus = version == 3;
  const unsigned increment = kCdfPlaces[version].increments + 20, functions = kCdfPlaces[version].functions;
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
       mov_number(2, increment / 16),
       lsl(2, 2, 4),
       add_number(2, increment % 16),
       add(1, 1, 2),
       str(6, 1, 0),  // increment 5
       mov_number(2, 0),
       lsl(3, 6, 24),
       mov_number(4, functions / 16),
       lsl(4, 4, 4),
       add_number(4, 1),  // as the makers' header has it: BX to an even address would end the call
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

// The program's choices in CDFJ+, at the places of driver version 48.
inline void put_choices(Image& image, bool loads_x, bool loads_y, unsigned first_stream) {
  const auto put_bytes = [&](std::size_t at, std::initializer_list<unsigned> bytes) {
    for (const unsigned byte : bytes) image[at++] = static_cast<std::uint8_t>(byte);
  };
  put_bytes(0x34C, {loads_x ? 0xA2U : 0xA9U, 0x00, 0x52, 0x13});
  put_bytes(0x350, {loads_y ? 0xA0U : 0xA9U, 0x00, 0x52, 0x13});
  put_bytes(0x3E0, {first_stream, 0x20, 0x42, 0xE2});
}

template <unsigned kVersion>
struct ModelCdf : Copyable<ModelCdf<kVersion>> {
  static constexpr bool kPlus = kVersion == 3;
  static constexpr CdfPlaces kPlaces = kCdfPlaces[kVersion];

  explicit ModelCdf(Image bytes) : Copyable<ModelCdf>(std::move(bytes)) {
    const std::size_t size = image.size();
    ram.resize(size <= 32768 ? 8192 : size <= 131072 ? 16384 : 32768);
    for (std::size_t i = 0; i < 2048; ++i) ram[i] = image[i];
    find_choices();
  }
  using CartridgeModel::image;
  std::vector<unsigned> ram;
  std::array<std::uint32_t, 3> frequency{}, phase{};
  unsigned bank = kPlus ? 0 : 6;
  bool fast = false, waves = false, waits = false, stands = false;
  bool loads_x = false, loads_y = false;
  unsigned next = 0, rest = 0, opcode = 0, jump = 0, first = 0;
  std::int64_t counted = 0;

  static constexpr unsigned kFraction = kPlus ? 16 : 20;

  bool driver_has(std::size_t at, std::initializer_list<int> bytes) const {
    return std::equal(bytes.begin(), bytes.end(), image.begin() + static_cast<std::ptrdiff_t>(at));
  }

  void find_choices() {
    for (std::size_t at = 2044; kPlus && at > 0; --at) {
      loads_x |= driver_has(at, {0xA2, 0x00, 0x52, 0x13});
      loads_y |= driver_has(at, {0xA0, 0x00, 0x52, 0x13});
      if (driver_has(at, {0x20, 0x42, 0xE2})) first = image[at - 1] <= 220 ? image[at - 1] : 0;
    }
  }

  std::uint32_t word(unsigned at) const {
    return ram[at] | ram[at + 1] << 8U | ram[at + 2] << 16U | std::uint32_t{ram[at + 3]} << 24U;
  }
  void set_word(unsigned at, std::uint32_t number) {
    for (unsigned i = 0; i < 4; ++i) ram[at + i] = number >> (8 * i) & 0xFF;
  }
  unsigned& display(std::size_t i) { return ram[2048 + i]; }

  void arm() {
    waits = false;
    display(0) = (display(0) + 1) % 256;
    if (display(0) == 200) {
      stands = true;
      return;
    }
    display(1) = (display(1) + display(0)) % 256;
    set_word(kPlaces.increments + 20, display(0));
    frequency[0] = std::uint32_t{display(0)} << 24;
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
    return place >= 0x40000000 && place - 0x40000000 < ram.size() ? ram[place - 0x40000000] : 0;
  }

  unsigned amplitude_now() const {
    if (waves) {
      unsigned sum = 0;
      for (unsigned v = 0; v < 3; ++v) sum += byte_at(word(kPlaces.waveforms + 4 * v) + (phase[v] >> 27));
      return sum % 256;
    }
    const std::uint32_t nibble = phase[0] >> (kPlus ? 12 : 20);
    const unsigned pair = byte_at(word(kPlaces.waveforms) + nibble / 2);
    if (nibble % 2 == 0) return pair / 16;
    return kPlus ? pair : pair % 16;
  }

  unsigned amplitude(int cycle) {
    pass(cycle);
    const unsigned now = amplitude_now(), before = ram[0x1BC];
    if (!kPlus) return now;
    ram[0x1BC] = now;
    return before;
  }

  // `step`: in parts of 256.
  unsigned take(unsigned i, std::uint32_t step) {
    const std::uint32_t pointer = word(kPlaces.pointers + 4 * i), place = pointer >> kFraction;
    set_word(kPlaces.pointers + 4 * i, pointer + (step << (kFraction - 8)));
    return byte_at(0x40000800 + place);
  }
  unsigned stream(unsigned i) { return take(i, word(kPlaces.increments + 4 * i)); }

  bool loads() const { return opcode == 0xA9 || (loads_x && opcode == 0xA2) || (loads_y && opcode == 0xA0); }

  unsigned loaded(unsigned value, int cycle) {
    if (value < first || value > first + kPlaces.amplitude) return value;
    return value == first + kPlaces.amplitude ? amplitude(cycle) : stream(value - first);
  }

  void touch(unsigned a) {
    if (a < 0x1FF4 || a > 0x1FFB) return;
    if (kPlus)
      bank = a == 0x1FFB ? 0 : a - 0x1FF4;
    else
      bank = a == 0x1FF4 ? 6 : a - 0x1FF5;
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
    if (rest == 0) return jump != 0 ? take(jump, 256) : value;
    if (value > kPlaces.amplitude - 34 || byte_of_bank(a + 1) != 0) return value;
    jump = 33 + value;
    return take(jump, 256);
  }

  void write(unsigned a, unsigned v) override {
    if (waits) arm();
    touch(a);
    const unsigned comm = kPlaces.pointers + 4 * 32;
    const std::uint32_t pointer = word(comm), place = pointer >> kFraction;
    if (a == 0x1FF0) {
      if (2048 + place < ram.size()) display(place) = v;
      set_word(comm, pointer + (1U << kFraction));
    }
    if (a == 0x1FF1) set_word(comm, (place * 256 + v) << kFraction);
    if (a == 0x1FF2) fast = v % 16 == 0, waves = v / 16 != 0, next = rest = opcode = jump = 0;
    if (a == 0x1FF3) waits = !stands;
  }
};

}  // namespace racebeam::test
