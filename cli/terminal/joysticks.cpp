#include "cli/terminal/joysticks.hpp"

#include <algorithm>
#include <string_view>

namespace racebeam {
namespace {

// The names of actions consist of these, in this order.
constexpr std::array<std::string_view, 5> kNames = {"UP", "DOWN", "RIGHT", "LEFT", "FIRE"};
constexpr std::size_t kFire = 4;
constexpr std::array<std::array<int, 5>, 2> kKeys = {
    {{kKeyUp, kKeyDown, kKeyRight, kKeyLeft, ' '}, {'w', 's', 'd', 'a', 'g'}}};

}  // namespace

void Joysticks::handle(const TerminalEvent& event, Time now) {
  for (std::size_t player = 0; player < kPlayers; ++player) {
    const auto found = std::ranges::find(kKeys[player], event.key);
    if (found == kKeys[player].end()) continue;
    const auto which = static_cast<std::size_t>(found - kKeys[player].begin());
    auto& until = pressed_until_[player];
    if (event.kind == TerminalEvent::Kind::kRelease) {
      until[which] = {};
    } else {
      until[which] = releases_are_told_ ? Time::max() : now + kHeld;
      if (which != kFire) until[which ^ 1] = {};
    }
  }
}

std::string Joysticks::action(Time now) const {
  const std::string b = action_of(1, now);
  return b == "NOOP" ? action_of(0, now) : action_of(0, now) + "/" + b;
}

std::string Joysticks::action_of(std::size_t player, Time now) const {
  std::string name;
  for (std::size_t which = 0; which < kSwitches; ++which)
    if (pressed_until_[player][which] > now) name.append(kNames[which]);
  return name.empty() ? "NOOP" : name;
}

}  // namespace racebeam
