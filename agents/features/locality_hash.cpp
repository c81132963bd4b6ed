#include "agents/features/locality_hash.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "agents/base/random.hpp"

namespace racebeam {

LocalityHash::LocalityHash(int vectors, int ones, int buckets, std::uint64_t seed)
    : buckets_(static_cast<std::uint32_t>(buckets)),
      first_(kScreenBits + 1),
      sums_(static_cast<std::size_t>(vectors)) {
  struct One {
    std::uint32_t bit;
    Entry entry;
  };
  Random random(seed);
  std::vector<One> all;
  std::vector<std::uint32_t> owner(kVectorBits);  // the last vector that has a bit, from 1
  for (std::size_t vector = 0; vector < sums_.size(); ++vector) {
    for (int remaining = ones; remaining > 0;) {
      const std::size_t bit = random.below(owner.size());
      if (owner[bit] == vector + 1) continue;  // the ones of a vector are distinct
      owner[bit] = static_cast<std::uint32_t>(vector + 1);
      const auto hash = static_cast<std::uint16_t>(random.below(buckets_));
      if (bit < kScreenBits)
        all.push_back({static_cast<std::uint32_t>(bit), {static_cast<std::uint16_t>(vector), hash}});
      --remaining;
    }
  }
  std::ranges::stable_sort(all, {}, &One::bit);
  for (const One& one : all) {
    entries_.push_back(one.entry);
    ++first_[one.bit + 1];
  }
  for (std::size_t bit = 1; bit < first_.size(); ++bit) first_[bit] += first_[bit - 1];
  forget();
}

void LocalityHash::forget() {
  before_.fill(0);
  owners_.fill(0);
  std::ranges::fill(sums_, 0);
  for (std::size_t pixel = 0; pixel < kFeaturePixels; ++pixel) {
    owners_[pixel] = 1;
    add(pixel, 1);
  }
}

// A bit of the screen that is set adds its hashes; with a sign of -1, one that was set takes them away.
void LocalityHash::add(std::size_t bit, std::int32_t sign) {
  for (std::uint32_t at = first_[bit]; at < first_[bit + 1]; ++at)
    sums_[entries_[at].vector] += sign * entries_[at].hash;
}

void LocalityHash::apply(const Change& change) {
  const std::size_t before = change.pixel + change.before, now = change.pixel + change.now;
  if (--owners_[before] == 0) add(before, -1);
  if (owners_[now]++ == 0) add(now, 1);
}

void LocalityHash::find_changes(Screen screen) {
  constexpr std::uint64_t kSevenBits = 0x7F7F7F7F7F7F7F7F;
  changes_.clear();
  for (std::size_t pixel = 0; pixel < kFeaturePixels; pixel += 8) {
    std::uint64_t now, before;
    std::memcpy(&now, screen.data() + pixel, 8);
    std::memcpy(&before, before_.data() + pixel, 8);
    now = (now >> 1) & kSevenBits;
    std::uint64_t differs = now ^ before;
    if (differs == 0) continue;
    std::memcpy(before_.data() + pixel, &now, 8);
    while (differs != 0) {
      const auto shift = static_cast<unsigned>(std::countr_zero(differs)) & ~7U;
      changes_.push_back({static_cast<std::uint32_t>(pixel) + shift / 8,
                          static_cast<std::uint8_t>(before >> shift),
                          static_cast<std::uint8_t>(now >> shift)});
      differs &= ~(std::uint64_t{0xFF} << shift);
    }
  }
}

void LocalityHash::extract(Screen screen, ActiveFeatures& active) {
  find_changes(screen);
  for (const Change& change : changes_) apply(change);
  active.clear();
  for (std::size_t vector = 0; vector < sums_.size(); ++vector)
    active.indices.push_back(static_cast<std::uint32_t>(vector * buckets_) +
                             static_cast<std::uint32_t>(sums_[vector]) % buckets_);
}

}  // namespace racebeam
