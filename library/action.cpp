#include "racebeam/action.hpp"

#include "games/game/actions.hpp"

namespace racebeam::v0 {

static_assert(kActions == racebeam::kActions && kConsoleActions == racebeam::kConsoleActions);
static_assert(static_cast<int>(Action::kBlackAndWhite) == racebeam::kBlackAndWhiteAction);
static_assert(static_cast<int>(Action::kKey1) == racebeam::kFirstKey);
static_assert(static_cast<int>(Action::kKeyHash) == racebeam::kFirstKey + racebeam::kKeys - 1);
static_assert(static_cast<int>(Buttons::kC) == kWithC &&
              static_cast<int>(Buttons::kTrigger) == kWithTrigger &&
              static_cast<int>(Buttons::kBooster) == kWithBooster &&
              static_cast<int>(Buttons::kTriggerAndBooster) == kWithBoth);

std::string_view name_of(Action action) noexcept { return action_name(static_cast<int>(action)); }

std::optional<Action> action_named(std::string_view name) noexcept {
  const auto number = action_number(name);
  if (!number) return std::nullopt;
  return static_cast<Action>(*number);
}

}  // namespace racebeam::v0
