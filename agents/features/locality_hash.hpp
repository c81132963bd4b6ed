// LSH: the screen as a vector of bits, projected on random vectors, each of which hashes to one feature
// (appendix A.4 of the paper; docs/paper-notes.md, "Features").
#pragma once

#include "agents/features/feature_set.hpp"
#include "agents/features/screen.hpp"

namespace racebeam {

class LocalityHash final : public FeatureSet {
 public:
  // So many random vectors with so many ones; each has a table of `buckets` features.
  LocalityHash(int vectors, int ones, int buckets, std::uint64_t seed);

  std::size_t size() const override { return sums_.size() * buckets_; }
  void extract(const Environment& machine, ActiveFeatures& active) override {
    extract(screen_.of(machine), active);
  }
  // Only pixels that changed since the screen before are looked at.
  void extract(Screen screen, ActiveFeatures& active);

  // Forgets the screen before: the next sums are computed from nothing. The features are the same.
  void forget();

 private:
  static constexpr std::size_t kBitsOfColour = 7;

  // That a bit is in a vector, and the bit's hash there.
  struct Entry {
    std::uint16_t vector;
    std::uint16_t hash;
  };

  void change(std::size_t pixel, std::uint8_t before, std::uint8_t now);

  const std::uint32_t buckets_;
  std::vector<std::uint32_t> first_;  // of each bit's entries; one more for the end
  std::vector<Entry> entries_;
  std::vector<std::int32_t> sums_;                     // of each vector: hashes of the bits that both have
  std::array<std::uint8_t, kFeaturePixels> before_{};  // colours
  FeatureScreen screen_;
};

}  // namespace racebeam
