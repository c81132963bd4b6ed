#include "racebeam/action.hpp"

#include "games/game/actions.hpp"

namespace racebeam::v0 {

static_assert(kActions == racebeam::kActions && kConsoleActions == racebeam::kConsoleActions);
static_assert(static_cast<int>(Action::kBlackAndWhite) == racebeam::kBlackAndWhiteAction);

std::string_view name_of(Action action) noexcept { return action_name(static_cast<int>(action)); }

std::optional<Action> action_named(std::string_view name) noexcept {
  const auto number = action_number(name);
  if (!number) return std::nullopt;
  return static_cast<Action>(*number);
}

}  // namespace racebeam::v0
