// The sets of games that the literature reports.
#pragma once

#include <span>
#include <string_view>

namespace racebeam {

// A game, and how the paper of the set spells it.
struct SetGame {
  std::string_view name, paper_name;
};

struct GameSet {
  std::string_view name, summary;
  std::span<const SetGame> games;
};

std::span<const GameSet> game_sets();
const GameSet* find_game_set(std::string_view name);  // null if the name is unknown

}  // namespace racebeam
