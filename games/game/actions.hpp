// The names and numbers of an agent's actions (docs/spec/environment.md, 1).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace racebeam {

constexpr int kActions = 18;  // player A: 0-17; player B: the same with 18 added

// Player A's actions that press or move a switch of the console instead. The reference does not have them.
constexpr int kResetAction = 18, kSelectAction = 19;
constexpr int kLeftAAction = 20, kLeftBAction = 21, kRightAAction = 22, kRightBAction = 23;  // difficulties
constexpr int kColorAction = 24, kBlackAndWhiteAction = 25;
constexpr int kConsoleActions = 26;  // all of player A's

constexpr int kReferenceReset = 40;  // the reference's number of RESET; its act() takes that for NOOP

constexpr bool is_of_console(int action) { return action >= kResetAction && action <= kBlackAndWhiteAction; }

std::string_view action_name(int action);                 // player A's; "" for other numbers
std::optional<int> action_number(std::string_view name);  // player A's
std::vector<int> all_actions();                           // 0-17

}  // namespace racebeam
