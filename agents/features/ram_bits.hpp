// RAM: the bits of the console's memory that are 1, and all pairs of them (appendix A.5 of the paper).
#pragma once

#include <bit>

#include "agents/features/feature_set.hpp"

namespace racebeam {

class RamBits final : public FeatureSet {
 public:
  std::size_t size() const override { return kBits + pairs_of(kBits); }
  bool reads_screen() const override { return false; }
  void extract(const Environment& machine, ActiveFeatures& active) override {
    extract(machine.ram(), active);
  }

  // Feature 8 * byte + bit; then the pairs.
  void extract(std::span<const std::uint8_t, kRamSize> ram, ActiveFeatures& active) const {
    active.clear();
    for (std::uint32_t byte = 0; byte < kRamSize; ++byte) {
      for (unsigned bits = ram[byte]; bits != 0; bits &= bits - 1)
        active.indices.push_back(8 * byte + static_cast<std::uint32_t>(std::countr_zero(bits)));
    }
    append_pairs(active, kBits);
  }

 private:
  static constexpr std::uint32_t kBits = 8 * kRamSize;
};

}  // namespace racebeam
