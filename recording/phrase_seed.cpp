#include "recording/phrase_seed.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include "recording/sha256.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kMaxPhraseBytes = 1000;

}  // namespace

bool is_phrase(std::string_view text) {
  const bool is_plain = std::ranges::none_of(text, [](char letter) {
    return static_cast<unsigned char>(letter) < ' ' || letter == '\x7f' || letter == '"' || letter == '\\';
  });
  return !text.empty() && text.size() <= kMaxPhraseBytes && is_plain;
}

void check_phrase(std::string_view phrase) {
  if (!is_phrase(phrase)) throw InvalidInput("a phrase has " + std::string(kPhraseRule));
}

// Returns the first 32 bits of a digest with the highest bit cleared, so that any program can use the seed.
std::uint32_t seed_of_phrase(std::string_view phrase, std::string_view game, int trial, int episode) {
  std::string text(phrase);
  for (const std::string& part : {std::string(game), std::to_string(trial), std::to_string(episode)})
    (text += '\n') += part;
  const std::string digest = sha256_of(text);
  std::uint32_t number = 0;
  std::from_chars(digest.data(), digest.data() + 8, number, 16);
  return std::max(number & 0x7fffffffU, 1U);
}

}  // namespace racebeam
