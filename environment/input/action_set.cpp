#include "environment/input/action_set.hpp"

#include <cmath>
#include <numeric>

#include "games/game/actions.hpp"

namespace racebeam {

namespace {

// All of the console, and those that only player A's controller has.
std::vector<int> with_console(Controller controller) {
  std::vector<int> list(kConsoleActions);
  std::iota(list.begin(), list.end(), 0);
  const std::vector<int> more = actions_with(controller);
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

}  // namespace

std::vector<int> actions_of(ActionSet set, const Game& game, const Properties& properties) {
  switch (set) {
    case ActionSet::kFull: return all_actions();
    case ActionSet::kConsole: return with_console(properties.left);
    case ActionSet::kLegal: return game.legal_actions;
    default: return game.minimal_actions;
  }
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
