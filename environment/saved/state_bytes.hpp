// Values of states as bytes: their memory, one after the other.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "emulator/base/mersenne_twister.hpp"

namespace racebeam::state_bytes {

static_assert(std::endian::native == std::endian::little, "a state's bytes are the memory of its values");

template <class T>
void append(std::vector<std::uint8_t>& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

// `bytes` must have enough bytes, and begins after the value afterwards.
template <class T>
T take(std::span<const std::uint8_t>& bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes = bytes.subspan(sizeof value);
  return value;
}

std::uint32_t checksum(std::span<const std::uint8_t> bytes);  // CRC-32, as in zlib

using GeneratorWords = std::array<std::uint32_t, MersenneTwister::kWords + 1>;  // and the position

GeneratorWords words_of(const MersenneTwister& generator);
MersenneTwister generator_of(const GeneratorWords& words);  // throws InvalidInput for impossible ones

}  // namespace racebeam::state_bytes
