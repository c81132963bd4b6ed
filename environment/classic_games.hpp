// Games whose resets were others in ALE 0.6 than in 0.12; for Settings::classic alone. Found by running 0.6.0
// beside racebeam (docs/spec-notes.md).
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace racebeam {

// None of these had modes: in the default mode, the reset runs no mode program.
struct ClassicGame {
  std::string_view name;
  int idle_frames;  // run at the end of the reset, with nothing pressed
};

constexpr std::array<ClassicGame, 7> kClassicGames = {{
    {"adventure", 0},
    {"frogger", 1},
    {"galaxian", 0},
    {"king_kong", 1},
    {"lost_luggage", 0},
    {"mr_do", 0},
    {"turmoil", 0},
}};

// Null for a game that reset as it does in 0.12.
constexpr const ClassicGame* find_classic_game(std::string_view name) {
  const auto found = std::ranges::find(kClassicGames, name, &ClassicGame::name);
  return found == kClassicGames.end() ? nullptr : &*found;
}

}  // namespace racebeam
