// The generator of all agents: SplitMix64 (Steele, Lea and Flood 2014). Its state is one word, so that a
// checkpoint holds it, and its numbers are the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>

namespace racebeam {

class Random {
 public:
  explicit Random(std::uint64_t seed = 0) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  // A number from 0 to count - 1, without bias, by rejection. `count` is at least 1.
  std::size_t below(std::size_t count) {
    const std::uint64_t uneven = -std::uint64_t{count} % count;  // 2^64 mod count
    std::uint64_t number;
    do number = next();
    while (number < uneven);
    return static_cast<std::size_t>(number % count);
  }

  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }  // from 0 to below 1

 private:
  std::uint64_t state_;
};

}  // namespace racebeam
