// The switches of the console that keep their position: both difficulties, and colour or black and white.
#pragma once

#include <array>
#include <cstdint>

#include "games/game/actions.hpp"

namespace racebeam {

struct ConsoleSwitches {
  static constexpr int kLeftA = 1, kRightA = 2, kDifficulty = kLeftA | kRightA, kBlackAndWhite = 4;

  std::int16_t difficulty = 0;  // as it was set: kLeftA, kRightA
  std::int16_t moved = 0;  // the switches that actions have changed since the episode began; kBlackAndWhite

  int positions() const { return difficulty ^ moved; }

  void set_difficulty(int value) {
    difficulty = static_cast<std::int16_t>(value);
    moved &= kBlackAndWhite;
  }

  // An action of the console moves its switch. Others do nothing.
  void act(int action) {
    struct Row {
      int action, mask, position;
    };
    constexpr std::array<Row, 6> kRows = {{{kLeftAAction, kLeftA, kLeftA},
                                           {kLeftBAction, kLeftA, 0},
                                           {kRightAAction, kRightA, kRightA},
                                           {kRightBAction, kRightA, 0},
                                           {kColorAction, kBlackAndWhite, 0},
                                           {kBlackAndWhiteAction, kBlackAndWhite, kBlackAndWhite}}};
    if (action < kLeftAAction) return;
    for (const Row& row : kRows)
      if (row.action == action)
        moved = static_cast<std::int16_t>(((positions() & ~row.mask) | row.position) ^ difficulty);
  }
};

}  // namespace racebeam
