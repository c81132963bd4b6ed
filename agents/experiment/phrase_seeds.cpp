#include "agents/experiment/phrase_seeds.hpp"

#include <algorithm>
#include <charconv>

#include "agents/base/sealed_file.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kMostPhraseBytes = 1000;

// A number from 1, as the program writes it; 0 for other text.
int ordinal(std::string_view text) {
  const auto number = parse_number<int>(text);
  return number && *number > 0 && std::to_string(*number) == text ? *number : 0;
}

}  // namespace

void check_phrase(std::string_view phrase) {
  const bool is_plain = std::ranges::none_of(phrase, [](char letter) {
    return (letter >= 0 && letter < ' ') || letter == '\x7f' || letter == '"' || letter == '\\';
  });
  if (phrase.empty() || phrase.size() > kMostPhraseBytes || !is_plain)
    throw InvalidInput("a phrase has 1 to " + std::to_string(kMostPhraseBytes) +
                       " bytes, without quotation marks, backslashes and control characters");
}

// The first 32 bits of a digest without the highest, so that any program can use the seed.
std::uint32_t seed_of_phrase(std::string_view phrase, std::string_view game, int trial, int episode) {
  std::string text(phrase);
  for (const std::string& part : {std::string(game), std::to_string(trial), std::to_string(episode)})
    (text += '\n') += part;
  const std::string digest = sha256_of(text);
  std::uint32_t number = 0;
  std::from_chars(digest.data(), digest.data() + 8, number, 16);
  return std::max(number & 0x7fffffffU, 1U);
}

std::string PhraseRows::fault(const ResultRow& row) {
  const std::string &game = field(row, "game"), &seed = field(row, "environment_seed");
  const int trial = ordinal(field(row, "trial")), episode = ordinal(field(row, "episode"));
  if (trial == 0 || episode == 0)
    return "trial is '" + field(row, "trial") + "' and episode is '" + field(row, "episode") +
           "'; with a phrase, both count from 1";
  Episodes& own = trials_.try_emplace({game, trial}, Episodes{.unit = row[0]}).first->second;
  if (own.unit != row[0])
    return "trial " + std::to_string(trial) + " of " + game + " is the unit " + own.unit +
           "; with a phrase, no other unit has its seeds";
  ++own.count;
  own.last = std::max(own.last, episode);
  const std::string expected = std::to_string(seed_of_phrase(phrase_, game, trial, episode));
  return seed == expected ? "" : "environment_seed is '" + seed + "'; the phrase gives '" + expected + "'";
}

void PhraseRows::each_gap(const std::function<void(const std::string& sentence)>& visit) const {
  for (const auto& [trial, own] : trials_)
    if (own.count != own.last)
      visit("results.csv: " + own.unit + " has " + std::to_string(own.count) + " episodes, and the last is " +
            std::to_string(own.last) + "; with a phrase, none is left out");
}

}  // namespace racebeam
