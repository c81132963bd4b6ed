// One word of `act`: A[@STRENGTH][/B[@STRENGTH]][*TIMES].
#pragma once

#include <cstdint>
#include <string_view>

namespace racebeam {

struct Action {
  int a = 0, b = 18;  // as Environment::act takes them
  float strength_a = 1, strength_b = 0;
  int times = 1;
};

// The actions that a client may ask for, for sentences: the numbers with bits set in `allowed`.
struct AllowedActions {
  std::string_view game;
  std::uint32_t allowed;  // bit n: action n
};

// Throws Refusal.
Action parse_action(std::string_view word, const AllowedActions& actions);

}  // namespace racebeam
