#include "emulator/sound.hpp"

namespace racebeam {
namespace {

using Channel = Sound::Channel;

constexpr unsigned bit(unsigned value, int number) { return value >> number & 1; }

// Both shift registers keep eight bits; only the low four or five matter, and bit 5 for what falls out.
constexpr void shift_in(std::uint8_t& shift_register, unsigned value) {
  shift_register = static_cast<std::uint8_t>(shift_register << 1 | value);
}

void clock_poly5(std::uint8_t& b) {
  if ((b & 31) == 0) {
    b = 1;
  } else {
    shift_in(b, bit(b, 4) ^ bit(b, 2));
  }
}

void clock_poly4(std::uint8_t& a) {
  if ((a & 15) == 0) {
    a = 1;
  } else {
    shift_in(a, bit(a, 3) ^ bit(a, 2));
  }
}

void divide_by_2(std::uint8_t& a) { shift_in(a, 1 - bit(a, 0)); }

void divide_by_6(std::uint8_t& a) {
  const unsigned in = bit(a, 2) == 0 && (a & 7) != 0 ? 1 : 0;
  a = static_cast<std::uint8_t>(~a);
  shift_in(a, in);
}

// Both registers in a row are one of nine bits.
void clock_poly9(Channel& c) {
  if ((c.poly5 & 31) == 0 && (c.poly4 & 15) == 0) {
    c.poly5 = 1;
  } else {
    shift_in(c.poly5, bit(c.poly4, 3) ^ bit(c.poly5, 4));
  }
  shift_in(c.poly4, bit(c.poly5, 5));
}

// What the waveform does when the divider runs out (audio.md, section 4).
void clock(Channel& c, unsigned waveform) {
  const bool uses_poly5 = waveform == 2 || waveform == 3 || waveform == 6 || waveform == 7 || waveform == 9 ||
                          waveform == 10 || waveform >= 14;
  if (uses_poly5) clock_poly5(c.poly5);
  const bool gate31 = (c.poly5 & 15) == 8, gate5 = bit(c.poly5, 4) != 0;
  switch (waveform) {
    case 1: clock_poly4(c.poly4); break;
    case 2: if (gate31) clock_poly4(c.poly4); break;
    case 3: if (gate5) clock_poly4(c.poly4); break;
    case 4: case 5: divide_by_2(c.poly4); break;
    case 6: if (gate31) divide_by_2(c.poly4); break;
    case 7: if (gate5) divide_by_2(c.poly4); break;
    case 8: clock_poly9(c); break;
    case 9: shift_in(c.poly4, bit(c.poly5, 5)); break;
    case 10: if (gate31) shift_in(c.poly4, bit(c.poly5, 4)); break;
    case 12: case 13: divide_by_6(c.poly4); break;
    case 14: if (gate31) divide_by_6(c.poly4); break;
    case 15: if (gate5) divide_by_6(c.poly4); break;
    default: shift_in(c.poly4, 1);  // 0 and 11: silence at the upper level
  }
}

void tick(Channel& c, unsigned waveform, unsigned frequency) {
  if (++c.divider <= frequency) return;
  c.divider = 0;
  clock(c, waveform);
}

}  // namespace

void Sound::generate(std::span<std::uint8_t, kSamplesPerBlock> samples) {
  for (std::uint8_t& sample : samples) sample = 128;
  for (std::size_t n = 0; n < channel.size(); ++n) {
    const unsigned waveform = registers[n] & 15u, frequency = registers[2 + n] & 31u;
    const unsigned level = 4 * (registers[4 + n] & 15u);
    Channel c = channel[n];
    for (std::uint8_t& sample : samples) {
      tick(c, waveform, frequency);
      sample = static_cast<std::uint8_t>(sample + bit(c.poly4, 3) * level);
    }
    channel[n] = c;
  }
}

}  // namespace racebeam
