// MT19937: the numbers of std::mt19937. Unlike the library's generator, it has the same state, and the same
// bytes of it, with every C++ library (docs/states.md, "Bytes of the portable form").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace racebeam {

class MersenneTwister {
 public:
  using result_type = std::uint32_t;
  static constexpr std::size_t kWords = 624;
  static constexpr std::uint32_t kDefaultSeed = 5489;

  explicit MersenneTwister(std::uint32_t seed_value = kDefaultSeed) { seed(seed_value); }

  // Continues from a state that words() and position() returned. The position is at most kWords.
  MersenneTwister(std::span<const std::uint32_t, kWords> words, std::uint32_t position)
      : position_(position) {
    for (std::size_t i = 0; i < kWords; ++i) words_[i] = words[i];
  }

  void seed(std::uint32_t value) {
    words_[0] = value;
    for (std::uint32_t i = 1; i < kWords; ++i) {
      const std::uint32_t last = words_[i - 1];
      words_[i] = 1812433253U * (last ^ last >> 30) + i;
    }
    position_ = kWords;
  }

  std::uint32_t operator()() {
    if (position_ >= kWords) renew();
    std::uint32_t y = words_[position_++];
    y ^= y >> 11;
    y ^= y << 7 & 0x9D2C5680U;
    y ^= y << 15 & 0xEFC60000U;
    return y ^ y >> 18;
  }

  // Skips `count` numbers.
  void discard(std::uint64_t count) {
    while (count > kWords - position_) {
      count -= kWords - position_;
      renew();
    }
    position_ += static_cast<std::uint32_t>(count);
  }

  // The words from which the next numbers are computed, from the position on. At kWords, new ones are
  // computed first.
  std::span<const std::uint32_t, kWords> words() const { return words_; }
  std::uint32_t position() const { return position_; }

  bool operator==(const MersenneTwister&) const = default;

 private:
  // Each word becomes a mixture of itself, the next one, and the one 397 places further on.
  void renew() {
    constexpr std::size_t kFar = 397;
    for (std::size_t i = 0; i < kWords; ++i) {
      const std::uint32_t both = (words_[i] & 0x80000000U) | (words_[(i + 1) % kWords] & 0x7FFFFFFFU);
      words_[i] = words_[(i + kFar) % kWords] ^ both >> 1 ^ (both & 1 ? 0x9908B0DFU : 0U);
    }
    position_ = 0;
  }

  std::array<std::uint32_t, kWords> words_;
  std::uint32_t position_;
};

}  // namespace racebeam
