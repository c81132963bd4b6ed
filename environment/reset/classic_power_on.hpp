// Random contents as in ALE 0.4 to 0.6, where one generator served the machine and the sticky actions
// (docs/spec/classic-protocol.md, 6, rules 1 and 2).
#pragma once

#include "emulator/base/mersenne_twister.hpp"
#include "emulator/state/power_on.hpp"

namespace racebeam {

// The generator's position is not part of a machine's state: a restored machine continues from the
// generator's current position.
class ClassicPowerOn : public PowerOn {
 public:
  explicit ClassicPowerOn(MersenneTwister& shared) : shared_(shared) {}

  std::uint32_t draw(std::uint32_t& drawn) override {
    ++drawn;
    return shared_();
  }

  // Once, when the image is loaded; resets keep the contents.
  void fill_cartridge(std::span<std::uint8_t> ram, std::uint32_t&) override {
    if (filled_) return;
    filled_ = true;
    MersenneTwister own;  // with the default seed
    for (std::uint8_t& byte : ram) byte = static_cast<std::uint8_t>(own());
  }

 private:
  MersenneTwister& shared_;
  bool filled_ = false;
};

}  // namespace racebeam
