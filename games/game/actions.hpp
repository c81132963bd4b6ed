// The names and numbers of an agent's actions (docs/spec/environment.md, 1).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace racebeam {

constexpr int kActions = 18;      // player A: 0-17; player B: the same with 18 added
constexpr int kResetAction = 40;  // the console's RESET switch

std::string_view action_name(int action);  // "NOOP" for 0 and 18, "RESET" for 40, "" for others
std::optional<int> action_number(std::string_view name);  // player A's, or kResetAction
std::vector<int> all_actions();                           // 0-17

}  // namespace racebeam
