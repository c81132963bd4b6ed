#include "games/game/actions.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

namespace racebeam {
namespace {

constexpr std::array<std::string_view, kFirstKey + kKeys> kNames = {
    "NOOP",     "FIRE",     "UP",          "RIGHT",      "LEFT",          "DOWN",
    "UPRIGHT",  "UPLEFT",   "DOWNRIGHT",   "DOWNLEFT",   "UPFIRE",        "RIGHTFIRE",
    "LEFTFIRE", "DOWNFIRE", "UPRIGHTFIRE", "UPLEFTFIRE", "DOWNRIGHTFIRE", "DOWNLEFTFIRE",
    "RESET",    "SELECT",   "LEFT_A",      "LEFT_B",     "RIGHT_A",       "RIGHT_B",
    "COLOR",    "BW",       "KEY1",        "KEY2",       "KEY3",          "KEY4",
    "KEY5",     "KEY6",     "KEY7",        "KEY8",       "KEY9",          "KEYSTAR",
    "KEY0",     "KEYHASH"};

struct Buttons {
  int first;
  std::string_view name;
};
constexpr std::array<Buttons, 4> kMoreButtons = {{{kWithC, "+C"},
                                                  {kWithTrigger, "+TRIGGER"},
                                                  {kWithBooster, "+BOOSTER"},
                                                  {kWithBoth, "+TRIGGER+BOOSTER"}}};

// By number; empty where no action has the number.
const std::array<std::string, kActionNumbers>& names() {
  static const auto all = [] {
    std::array<std::string, kActionNumbers> list;
    std::ranges::copy(kNames, list.begin());
    for (const Buttons& buttons : kMoreButtons)
      for (std::size_t action = 0; action < kActions; ++action)
        list[static_cast<std::size_t>(buttons.first) + action] =
            std::string(kNames[action]).append(buttons.name);
    return list;
  }();
  return all;
}

}  // namespace

std::string_view action_name(int action) {
  return is_action(action) ? std::string_view(names()[static_cast<std::size_t>(action)]) : std::string_view{};
}

std::optional<int> action_number(std::string_view name) {
  if (name.empty()) return std::nullopt;
  const auto found = std::ranges::find(names(), name);
  return found == names().end() ? std::nullopt : std::optional(static_cast<int>(found - names().begin()));
}

std::vector<int> all_actions() {
  std::vector<int> list(kActions);
  std::iota(list.begin(), list.end(), 0);
  return list;
}

std::vector<int> actions_with(Controller controller) {
  const auto from = [](int first, int count) {
    std::vector<int> list(static_cast<std::size_t>(count));
    std::iota(list.begin(), list.end(), first);
    return list;
  };
  if (controller == Controller::kKeyboard) return from(kFirstKey, kKeys);
  if (controller == Controller::kGenesis) return from(kWithC, kActions);
  if (controller != Controller::kBooster) return {};
  std::vector<int> all;
  for (const int first : {kWithTrigger, kWithBooster, kWithBoth}) {
    const std::vector<int> some = from(first, kActions);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace racebeam
