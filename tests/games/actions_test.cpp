#include "games/game/actions.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <tuple>

using namespace racebeam;

TEST_CASE("an action's number is that of its name, and other numbers have no name") {
  int named = 0;
  for (int number = -1; number <= kActionNumbers; ++number) {
    const std::string_view name = action_name(number);
    INFO(number);
    CHECK(name.empty() == !is_action(number));
    if (name.empty()) continue;
    CHECK(action_number(name) == number);
    ++named;
  }
  CHECK(named == kActions + 8 + kKeys + 4 * kActions);
  for (const char* none : {"", "noop", "JUMP", "FIRE+", "RESET+C"}) CHECK_FALSE(action_number(none));
}

TEST_CASE("actions have the names and numbers of the specification") {
  const std::pair<int, const char*> rows[] = {{0, "NOOP"},
                                              {1, "FIRE"},
                                              {2, "UP"},
                                              {17, "DOWNLEFTFIRE"},
                                              {18, "RESET"},
                                              {19, "SELECT"},
                                              {25, "BW"},
                                              {26, "KEY1"},
                                              {37, "KEYHASH"},
                                              {64, "NOOP+C"},
                                              {97, "FIRE+TRIGGER"},
                                              {145, "DOWNLEFTFIRE+BOOSTER"},
                                              {160, "NOOP+TRIGGER+BOOSTER"}};
  for (const auto& [number, name] : rows) CHECK(action_name(number) == name);
}

TEST_CASE("player B has the actions of player A, except those of the console") {
  for (int number = -1; number <= kActionNumbers + kActions; ++number) {
    const int own = number - kActions;
    INFO(number);
    CHECK(is_action_of_b(number) == (is_action(own) && (own < 18 || own > 25)));
  }
  CHECK(all_actions().size() == 18);
  CHECK(all_actions().back() == 17);
}

TEST_CASE("a controller's own actions are in the order of their numbers") {
  const auto range = [](const std::vector<int>& actions) {
    return std::tuple(actions.size(), actions.front(), actions.back());
  };
  CHECK(range(actions_with(Controller::kKeyboard)) == std::tuple(12U, 26, 37));
  CHECK(range(actions_with(Controller::kGenesis)) == std::tuple(18U, 64, 81));
  CHECK(range(actions_with(Controller::kBooster)) == std::tuple(54U, 96, 177));
  for (const Controller other : {Controller::kJoystick, Controller::kPaddles, Controller::kNone})
    CHECK(actions_with(other).empty());
  for (const Controller each : {Controller::kKeyboard, Controller::kGenesis, Controller::kBooster}) {
    const auto actions = actions_with(each);
    CHECK(std::ranges::is_sorted(actions));
    CHECK(std::ranges::all_of(actions, is_action));
  }
}
