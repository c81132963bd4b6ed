// One word of `act`: A[@STRENGTH][/B[@STRENGTH]][*TIMES].
#pragma once

#include <bitset>
#include <string_view>

#include "environment/environment.hpp"
#include "games/game/actions.hpp"

namespace racebeam {

struct Action {
  Act act;
  int times = 1;
};

// The actions that a client may ask for. `game` is named in errors.
struct AllowedActions {
  std::string_view game;
  std::bitset<kActionNumbers> allowed, allowed_b;  // bit n: action n of player A; of player B, counted from 0
};

// Throws RequestError.
Action parse_action(std::string_view word, const AllowedActions& actions);

}  // namespace racebeam
