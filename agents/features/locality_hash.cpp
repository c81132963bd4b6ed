#include "agents/features/locality_hash.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "agents/base/random.hpp"

namespace racebeam {

LocalityHash::LocalityHash(int vectors, int ones, int buckets, std::uint64_t seed)
    : buckets_(static_cast<std::uint32_t>(buckets)),
      first_(kFeaturePixels * kBitsOfColour + 1),
      sums_(static_cast<std::size_t>(vectors)) {
  struct One {
    std::uint32_t bit;
    Entry entry;
  };
  Random random(seed);
  std::vector<One> all;
  std::vector<std::uint32_t> owner(kFeaturePixels * kBitsOfColour);  // the last vector that has a bit, from 1
  for (std::uint16_t vector = 0; vector < sums_.size(); ++vector) {
    for (int left = ones; left > 0;) {
      const std::size_t bit = random.below(owner.size());
      if (owner[bit] == vector + 1U) continue;  // the ones of a vector are distinct
      owner[bit] = vector + 1U;
      const auto hash = static_cast<std::uint16_t>(random.below(buckets_));
      all.push_back({static_cast<std::uint32_t>(bit), {vector, hash}});
      --left;
    }
  }
  std::ranges::stable_sort(all, {}, &One::bit);
  for (const One& one : all) {
    entries_.push_back(one.entry);
    ++first_[one.bit + 1];
  }
  for (std::size_t bit = 1; bit < first_.size(); ++bit) first_[bit] += first_[bit - 1];
}

void LocalityHash::forget() {
  std::ranges::fill(sums_, 0);
  before_.fill(0);
}

void LocalityHash::change(std::size_t pixel, std::uint8_t before, std::uint8_t now) {
  for (unsigned left = before ^ now; left != 0; left &= left - 1) {
    const std::size_t bit = pixel * kBitsOfColour + static_cast<std::size_t>(std::countr_zero(left));
    const bool set = (now & left & -left) != 0;
    for (std::uint32_t at = first_[bit]; at < first_[bit + 1]; ++at) {
      const Entry& entry = entries_[at];
      sums_[entry.vector] += set ? entry.hash : -entry.hash;
    }
  }
}

void LocalityHash::extract(Screen screen, ActiveFeatures& active) {
  constexpr std::uint64_t kSevenBits = 0x7F7F7F7F7F7F7F7F;
  for (std::size_t pixel = 0; pixel < kFeaturePixels; pixel += 8) {
    std::uint64_t now, before;
    std::memcpy(&now, screen.data() + pixel, 8);
    std::memcpy(&before, before_.data() + pixel, 8);
    now = (now >> 1) & kSevenBits;
    std::uint64_t differs = now ^ before;
    if (differs == 0) continue;
    std::memcpy(before_.data() + pixel, &now, 8);
    while (differs != 0) {
      const auto shift = static_cast<std::size_t>(std::countr_zero(differs)) & ~std::size_t{7};
      change(pixel + shift / 8, static_cast<std::uint8_t>(before >> shift),
             static_cast<std::uint8_t>(now >> shift));
      differs &= ~(std::uint64_t{0xFF} << shift);
    }
  }
  active.clear();
  for (std::size_t vector = 0; vector < sums_.size(); ++vector)
    active.indices.push_back(static_cast<std::uint32_t>(vector * buckets_) +
                             static_cast<std::uint32_t>(sums_[vector]) % buckets_);
}

}  // namespace racebeam
