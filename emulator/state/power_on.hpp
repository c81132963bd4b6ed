// The source of the random contents of a machine that is switched on (docs/spec/riot.md, 2).
#pragma once

#include <cstdint>
#include <span>

#include "emulator/base/mersenne_twister.hpp"

namespace racebeam {

// `drawn` counts the draws that this machine has taken. It is part of the machine's state: a restored machine
// continues the sequence where the saved one stood.
class PowerOn {
 public:
  virtual ~PowerOn() = default;
  virtual std::uint32_t draw(std::uint32_t& drawn) = 0;  // the next 32-bit output
  // RAM on the cartridge, filled at every system reset.
  virtual void fill_cartridge(std::span<std::uint8_t> ram, std::uint32_t& drawn) = 0;
};

// Draws as ALE 0.12 does: from a separate MT19937, once for each byte of cartridge RAM.
class SystemGenerator : public PowerOn {
 public:
  explicit SystemGenerator(std::uint32_t seed) : seed_(seed), engine_(seed) {}

  std::uint32_t draw(std::uint32_t& drawn) override {
    if (drawn < position_) {  // An earlier state was restored: the sequence starts again.
      engine_.seed(seed_);
      position_ = 0;
    }
    engine_.discard(drawn - position_);
    position_ = ++drawn;
    return engine_();
  }

  void fill_cartridge(std::span<std::uint8_t> ram, std::uint32_t& drawn) override {
    for (std::uint8_t& byte : ram) byte = static_cast<std::uint8_t>(draw(drawn));
  }

 private:
  std::uint32_t seed_;
  MersenneTwister engine_;
  std::uint32_t position_ = 0;
};

}  // namespace racebeam
