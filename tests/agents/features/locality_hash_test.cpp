#include "agents/features/locality_hash.hpp"

#include <catch2/catch.hpp>

#include "agents/base/random.hpp"

using namespace racebeam;

namespace {

using Pixels = std::array<std::uint8_t, kFeaturePixels>;

std::vector<std::uint32_t> features(LocalityHash& set, const Pixels& screen) {
  ActiveFeatures active;
  set.extract(screen, active);
  return active.indices;
}

std::size_t shared(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] == b[i];
  return count;
}

}  // namespace

TEST_CASE("LSH has the paper's size, and one feature for each vector") {
  LocalityHash set(2000, 1000, 50, 1);
  CHECK(set.size() == 100000);
  const auto active = features(set, Pixels{});
  REQUIRE(active.size() == 2000);
  for (std::size_t vector = 0; vector < active.size(); ++vector) REQUIRE(active[vector] / 50 == vector);
}

TEST_CASE("LSH kept from screen to screen is LSH from scratch, over 10,000 screens") {
  LocalityHash hash(200, 1000, 50, 1), anew(200, 1000, 50, 1);
  Random random(3);
  Pixels screen{};
  for (int count = 0; count < 10000; ++count) {
    for (std::size_t changes = random.below(200); changes > 0; --changes)
      screen[random.below(screen.size())] = static_cast<std::uint8_t>(random.next());
    const auto active = features(hash, screen);
    if (count % 10 != 0) continue;
    anew.forget();
    REQUIRE(active == features(anew, screen));
  }
}

TEST_CASE("The more pixels change, the fewer features are shared") {
  LocalityHash set(2000, 1000, 50, 1);
  Random random(3);
  Pixels screen{};
  for (auto& pixel : screen) pixel = static_cast<std::uint8_t>(random.next());
  const auto first = features(set, screen);
  std::size_t last = first.size();
  for (const int changes : {100, 1000, 10000}) {
    Pixels changed = screen;
    for (int i = 0; i < changes; ++i) changed[random.below(changed.size())] ^= 0x7E;
    const std::size_t now = shared(first, features(set, changed));
    CHECK(now < last);
    last = now;
  }
  CHECK(features(set, screen) == first);
}

TEST_CASE("LSH has the sums that its definition has") {
  // Bits are drawn as documented: for each vector, distinct bits, each with a hash.
  constexpr std::size_t kVectors = 20, kOnes = 1000, kBuckets = 50;
  LocalityHash set(kVectors, kOnes, kBuckets, 9);
  Random draws(9), colours(4);
  Pixels screen;
  for (auto& pixel : screen) pixel = static_cast<std::uint8_t>(colours.next());
  std::vector<bool> is_set(7 * kFeaturePixels);
  for (std::size_t pixel = 0; pixel < screen.size(); ++pixel) is_set[pixel + (screen[pixel] >> 1)] = true;
  const auto active = features(set, screen);
  for (std::size_t vector = 0; vector < kVectors; ++vector) {
    std::vector<bool> drawn(is_set.size());
    std::size_t sum = 0;
    for (std::size_t count = 0; count < kOnes;) {
      const std::size_t bit = draws.below(drawn.size());
      if (drawn[bit]) continue;
      drawn[bit] = true;
      ++count;
      const std::size_t hash = draws.below(kBuckets);
      if (is_set[bit]) sum += hash;
    }
    REQUIRE(active[vector] == vector * kBuckets + sum % kBuckets);
  }
}

TEST_CASE("Each seed has its own vectors") {
  LocalityHash one(100, 1000, 50, 1), other(100, 1000, 50, 2);
  Pixels screen;
  screen.fill(0xFE);
  CHECK(features(one, screen) != features(other, screen));
}
