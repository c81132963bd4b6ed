#include "environment/input/action_set.hpp"

#include <cmath>
#include <numeric>

#include "games/game/actions.hpp"

namespace racebeam {

const std::vector<int>& actions_of(ActionSet set, const Game& game) {
  static const std::vector<int> full = all_actions();
  static const std::vector<int> console = [] {
    std::vector<int> list(kConsoleActions);
    std::iota(list.begin(), list.end(), 0);
    return list;
  }();
  if (set == ActionSet::kFull) return full;
  if (set == ActionSet::kConsole) return console;
  return set == ActionSet::kLegal ? game.legal_actions : game.minimal_actions;
}

Act act_of(float radius, float angle, float fire, float threshold) {
  // Rows: down, neither, up; columns: left, neither, right. Without FIRE, and with it.
  constexpr int kActionOf[2][3][3] = {{{9, 5, 8}, {4, 0, 3}, {7, 2, 6}},
                                      {{17, 13, 16}, {12, 1, 11}, {15, 10, 14}}};
  const float x = radius * std::cos(angle), y = radius * std::sin(angle);
  const auto part = [threshold](float value) { return value > threshold ? 2 : value < -threshold ? 0 : 1; };
  return {.a = kActionOf[fire > threshold][part(y)][part(x)], .strength_a = radius};
}

}  // namespace racebeam
