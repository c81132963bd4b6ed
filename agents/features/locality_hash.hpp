// LSH: the screen as a vector of bits, projected on random vectors, each of which hashes to one feature
// (appendix A.4 of the paper; docs/paper-notes.md, "Features").
#pragma once

#include "agents/base/huge_pages.hpp"
#include "agents/features/feature_set.hpp"
#include "agents/features/screen.hpp"

namespace racebeam {

class LocalityHash final : public FeatureSet {
 public:
  // Draws random vectors, each with this number of ones. Each has a table of `buckets` features.
  LocalityHash(int vectors, int ones, int buckets, std::uint64_t seed);

  std::size_t size() const override { return sums_.size() * buckets_; }
  void extract(const Environment& machine, ActiveFeatures& active) override {
    extract(screen_.of(machine), active);
  }
  // Only pixels that changed since the screen before are looked at.
  void extract(Screen screen, ActiveFeatures& active);

  // Forgets the screen before: the next sums are computed from a screen of colour 0. The features are the
  // same.
  void forget();

 private:
  // A pixel sets the bit at its number plus its colour. Pixels may share a bit. The vectors have seven bits
  // for each pixel, as in the paper, so that most of theirs are never set.
  static constexpr std::size_t kColours = 128;
  static constexpr std::size_t kScreenBits = kFeaturePixels + kColours - 1;
  static constexpr std::size_t kVectorBits = 7 * kFeaturePixels;

  // A vector that has a certain bit, and the bit's hash in it.
  struct Entry {
    std::uint16_t vector;
    std::uint16_t hash;
  };

  // A pixel with another colour than on the screen before.
  struct Change {
    std::uint32_t pixel;
    std::uint8_t before, now;
  };

  void find_changes(Screen screen);
  void apply(const Change& change);
  void add(std::size_t bit, std::int32_t sign);

  const std::uint32_t buckets_;
  HugeTable<std::uint32_t> first_;  // per bit of the screen: its entries; one more for the end
  HugeTable<Entry> entries_;
  std::vector<Change> changes_;
  std::vector<std::int32_t> sums_;                     // per vector: hashes of the bits that both have
  std::array<std::uint16_t, kScreenBits> owners_{};    // pixels that set this bit of the screen
  std::array<std::uint8_t, kFeaturePixels> before_{};  // colours
  FeatureScreen screen_;
};

}  // namespace racebeam
