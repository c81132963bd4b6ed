// The names and numbers of an agent's actions (docs/spec/environment.md, 1, and docs/spec/controllers.md).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "emulator/state/properties.hpp"

namespace racebeam {

constexpr int kActions = 18;  // player A: 0-17; player B: the same with 18 added

// Player A's actions that press or move a switch of the console instead. The reference does not have them.
constexpr int kResetAction = 18, kSelectAction = 19;
constexpr int kLeftAAction = 20, kLeftBAction = 21, kRightAAction = 22, kRightBAction = 23;  // difficulties
constexpr int kColorAction = 24, kBlackAndWhiteAction = 25;
constexpr int kConsoleActions = 26;  // those of a joystick, and of the console

// Either player's actions with other controllers. Keys: 1 to 9, star, 0, hash. A joystick's action with more
// buttons has its number added to one of these.
constexpr int kFirstKey = kConsoleActions, kKeys = 12;
constexpr int kWithC = 64, kWithTrigger = 96, kWithBooster = 128, kWithBoth = 160;
constexpr int kButtonActions = 32;   // between two of these
constexpr int kActionNumbers = 192;  // all numbers are below

constexpr int kReferenceReset = 40;  // the reference's number of RESET; its act() treats that as NOOP

constexpr bool is_of_console(int action) { return action >= kResetAction && action <= kBlackAndWhiteAction; }

constexpr bool is_key(int action) { return action >= kFirstKey && action < kFirstKey + kKeys; }

constexpr bool has_more_buttons(int action) {
  return action >= kWithC && action < kActionNumbers && action % kButtonActions < kActions;
}

// Player A's. Player B's are the same with 18 added, without those of the console.
constexpr bool is_action(int action) {
  return (action >= 0 && action < kFirstKey + kKeys) || has_more_buttons(action);
}
constexpr bool is_action_of_b(int action) {
  return is_action(action - kActions) && !is_of_console(action - kActions);
}

std::string_view action_name(int action);                 // player A's; "" for other numbers
std::optional<int> action_number(std::string_view name);  // player A's
std::vector<int> all_actions();                           // 0-17

// Those that only such a controller has, ascending.
std::vector<int> actions_with(Controller controller);

}  // namespace racebeam
