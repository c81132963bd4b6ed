#include "environment/saved/state_bytes.hpp"

#include <zlib.h>

#include <algorithm>

#include "environment/saved/saved_state_check.hpp"

namespace racebeam::state_bytes {

std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
}

GeneratorWords words_of(const MersenneTwister& generator) {
  GeneratorWords words;
  std::ranges::copy(generator.words(), words.begin());
  words.back() = generator.position();
  return words;
}

MersenneTwister generator_of(const GeneratorWords& words) {
  const auto state = std::span(words).first<MersenneTwister::kWords>();
  check_generator(state, words.back());
  return {state, words.back()};
}

}  // namespace racebeam::state_bytes
