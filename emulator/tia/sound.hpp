// The TIA's two sound channels and the block of samples that they produce (docs/spec/audio.md).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "emulator/tia/registers/registers.hpp"

namespace racebeam {

constexpr int kSamplesPerBlock = 512;

// It is beside the machine's state: neither a system reset nor a restored machine changes it. A client's
// saved state includes it.
struct Sound {
  // $15-$1A as last written: AUDC0 AUDC1 AUDF0 AUDF1 AUDV0 AUDV1. Samples are made once for each act, so that
  // only the last value of each register counts.
  std::array<std::uint8_t, 6> registers{};

  struct Channel {
    std::uint8_t divider = 0;  // ticks since the shift registers were clocked
    std::uint8_t poly4 = 1;    // A in docs/spec/audio.md
    std::uint8_t poly5 = 1;    // B in docs/spec/audio.md
  };
  std::array<Channel, 2> channel{};

  void write(unsigned reg, std::uint8_t value) { registers[reg - AUDC0] = value; }
  void generate(std::span<std::uint8_t, kSamplesPerBlock> samples);
};

}  // namespace racebeam
