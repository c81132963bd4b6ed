// A hash of a machine's state, for planners that reach the same state in different ways.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace racebeam {

// 64 bits from a stream of bytes. Sixteen bytes at a time are folded in with a multiplication of 64 by 64
// bits, whose halves are combined. Each bit of the input changes each bit of the result with a probability of
// about a half (tests/environment/state_hash_test.cpp). The hash is the same on all little-endian machines
// and in all versions. It is not safe against constructed collisions.
class StateHash {
 public:
  void add(std::span<const std::uint8_t> bytes) {
    const std::uint8_t* at = bytes.data();
    std::size_t left = bytes.size();
    for (; left >= 16; left -= 16, at += 16) mix(word(at), word(at + 8));
    std::array<std::uint8_t, 16> rest{};
    if (left > 0) std::memcpy(rest.data(), at, left);
    mix(word(rest.data()), word(rest.data() + 8));
    sum_ += bytes.size();  // zeros at the end count
  }

  template <typename T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T>, "padding would be hashed");
    add(std::span(reinterpret_cast<const std::uint8_t*>(&value), sizeof value));
  }

  std::uint64_t value() const { return fold(sum_ ^ kOne, kTwo); }

 private:
  // Odd numbers with about as many ones as zeros: the fraction of pi.
  static constexpr std::uint64_t kStart = 0x243F6A8885A308D3, kOne = 0x13198A2E03707345,
                                 kTwo = 0xA4093822299F31D1;

  static std::uint64_t word(const std::uint8_t* at) {
    std::uint64_t value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }

  static std::uint64_t fold(std::uint64_t a, std::uint64_t b) {
    __extension__ using Product = unsigned __int128;
    const Product product = static_cast<Product>(a) * b;
    return static_cast<std::uint64_t>(product >> 64) ^ static_cast<std::uint64_t>(product);
  }

  void mix(std::uint64_t low, std::uint64_t high) { sum_ = fold(low ^ sum_, high ^ kOne); }

  std::uint64_t sum_ = kStart;
};

}  // namespace racebeam
