#include "environment/saved/state_bytes.hpp"

#include <zlib.h>

#include <sstream>

#include "environment/saved/saved_state_check.hpp"

namespace racebeam::state_bytes {

std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
}

// The standard's only access to a generator's state is text.
GeneratorWords words_of(const MersenneTwister& generator) {
  std::stringstream text;
  text << generator;
  GeneratorWords words{};
  for (std::uint32_t& word : words) text >> word;
  return words;
}

MersenneTwister generator_of(const GeneratorWords& words) {
  check_generator(std::span(words).first<MersenneTwister::state_size>(), words.back());
  std::stringstream text;
  for (const std::uint32_t word : words) text << word << ' ';
  MersenneTwister generator;
  text >> generator;
  return generator;
}

}  // namespace racebeam::state_bytes
