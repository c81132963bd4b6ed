#include "emulator/tia/sound.hpp"

namespace racebeam {
namespace {

using Channel = Sound::Channel;

constexpr unsigned bit(unsigned value, int number) { return value >> number & 1; }

// Both shift registers keep eight bits. Only the low four or five matter, and bit 5 as the output.
void shift_in(std::uint8_t& shift_register, unsigned value) {
  shift_register = static_cast<std::uint8_t>(shift_register << 1 | value);
}

void clock_poly5(std::uint8_t& b) {
  if ((b & 31) == 0) {
    b = 1;
  } else {
    shift_in(b, bit(b, 4) ^ bit(b, 2));
  }
}

// The effect of a waveform on the register that is heard: A and B in docs/spec/audio.md, 4.
void one(Channel& c) { shift_in(c.poly4, 1); }
void divide_by_2(Channel& c) { shift_in(c.poly4, 1 - bit(c.poly4, 0)); }
void poly5_bit4(Channel& c) { shift_in(c.poly4, bit(c.poly5, 4)); }
void poly5_bit5(Channel& c) { shift_in(c.poly4, bit(c.poly5, 5)); }

void divide_by_6(Channel& c) {
  const unsigned in = bit(c.poly4, 2) == 0 && (c.poly4 & 7) != 0 ? 1 : 0;
  c.poly4 = static_cast<std::uint8_t>(~c.poly4);
  shift_in(c.poly4, in);
}

void poly4(Channel& c) {
  if ((c.poly4 & 15) == 0) {
    c.poly4 = 1;
  } else {
    shift_in(c.poly4, bit(c.poly4, 3) ^ bit(c.poly4, 2));
  }
}

// Both registers together are one of nine bits.
void poly9(Channel& c) {
  if ((c.poly5 & 31) == 0 && (c.poly4 & 15) == 0) {
    c.poly5 = 1;
  } else {
    shift_in(c.poly5, bit(c.poly4, 3) ^ bit(c.poly5, 4));
  }
  poly5_bit5(c);
}

// Whether the five-bit register is clocked first, and may hold the other back.
enum class Poly5 { kUnused, kFree, kGate31, kGate5 };

struct Waveform {
  Poly5 poly5;
  void (*shift)(Channel&);
};

constexpr std::array<Waveform, 16> kWaveforms = {{
    {Poly5::kUnused, one},          // 0
    {Poly5::kUnused, poly4},        // 1
    {Poly5::kGate31, poly4},        // 2
    {Poly5::kGate5, poly4},         // 3
    {Poly5::kUnused, divide_by_2},  // 4
    {Poly5::kUnused, divide_by_2},  // 5
    {Poly5::kGate31, divide_by_2},  // 6
    {Poly5::kGate5, divide_by_2},   // 7
    {Poly5::kUnused, poly9},        // 8
    {Poly5::kFree, poly5_bit5},     // 9
    {Poly5::kGate31, poly5_bit4},   // 10
    {Poly5::kUnused, one},          // 11
    {Poly5::kUnused, divide_by_6},  // 12
    {Poly5::kUnused, divide_by_6},  // 13
    {Poly5::kGate31, divide_by_6},  // 14
    {Poly5::kGate5, divide_by_6},   // 15
}};

bool lets_through(Poly5 use, std::uint8_t b) {
  if (use == Poly5::kGate31) return (b & 15) == 8;
  return use != Poly5::kGate5 || bit(b, 4) != 0;
}

void tick(Channel& c, const Waveform& waveform, unsigned frequency) {
  if (++c.divider <= frequency) return;
  c.divider = 0;
  if (waveform.poly5 != Poly5::kUnused) clock_poly5(c.poly5);
  if (lets_through(waveform.poly5, c.poly5)) waveform.shift(c);
}

}  // namespace

void Sound::generate(std::span<std::uint8_t, kSamplesPerBlock> samples) {
  for (std::uint8_t& sample : samples) sample = 128;
  for (std::size_t n = 0; n < channel.size(); ++n) {
    const Waveform& waveform = kWaveforms[registers[n] & 15];
    const unsigned frequency = registers[2 + n] & 31u, level = 4 * (registers[4 + n] & 15u);
    Channel c = channel[n];
    for (std::uint8_t& sample : samples) {
      tick(c, waveform, frequency);
      sample = static_cast<std::uint8_t>(sample + bit(c.poly4, 3) * level);
    }
    channel[n] = c;
  }
}

}  // namespace racebeam
