#include "agents/experiment/phrase_seeds.hpp"

#include <algorithm>

#include "recording/phrase_seed.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

// A number from 1, as the program writes it; 0 for other text.
int ordinal(std::string_view text) {
  const auto number = parse_number<int>(text);
  return number && *number > 0 && std::to_string(*number) == text ? *number : 0;
}

}  // namespace

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
