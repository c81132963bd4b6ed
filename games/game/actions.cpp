#include "games/game/actions.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace racebeam {
namespace {

constexpr std::array<std::string_view, kConsoleActions> kNames = {
    "NOOP",     "FIRE",     "UP",          "RIGHT",      "LEFT",          "DOWN",
    "UPRIGHT",  "UPLEFT",   "DOWNRIGHT",   "DOWNLEFT",   "UPFIRE",        "RIGHTFIRE",
    "LEFTFIRE", "DOWNFIRE", "UPRIGHTFIRE", "UPLEFTFIRE", "DOWNRIGHTFIRE", "DOWNLEFTFIRE",
    "RESET",    "SELECT",   "LEFT_A",      "LEFT_B",     "RIGHT_A",       "RIGHT_B",
    "COLOR",    "BW"};

}  // namespace

std::string_view action_name(int action) {
  const bool is_known = action >= 0 && action < kConsoleActions;
  return is_known ? kNames[static_cast<std::size_t>(action)] : std::string_view{};
}

std::optional<int> action_number(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  return found == kNames.end() ? std::nullopt : std::optional(static_cast<int>(found - kNames.begin()));
}

std::vector<int> all_actions() {
  std::vector<int> list(kActions);
  std::iota(list.begin(), list.end(), 0);
  return list;
}

}  // namespace racebeam
