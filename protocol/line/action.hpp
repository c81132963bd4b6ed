// One word of `act`: A[@STRENGTH][/B[@STRENGTH]][*TIMES].
#pragma once

#include <cstdint>
#include <string_view>

#include "environment/environment.hpp"

namespace racebeam {

struct Action {
  Act act;
  int times = 1;
};

// The actions that a client may ask for, for sentences: the numbers with bits set in `allowed`.
struct AllowedActions {
  std::string_view game;
  std::uint32_t allowed;  // bit n: action n
};

// Throws RequestError.
Action parse_action(std::string_view word, const AllowedActions& actions);

}  // namespace racebeam
