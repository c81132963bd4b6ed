// The actions that an agent chooses from.
#pragma once

#include <vector>

#include "environment/environment.hpp"

namespace racebeam {

enum class ActionSet { kFull, kLegal, kMinimal, kConsole };

// Player A's numbers, ascending. The controller matters for kConsole only.
std::vector<int> actions_of(ActionSet set, const Game& game, const Properties& properties = {});

// A joystick that is turned and tilted: `radius` 0 to 1, `angle` in radians, 0 to the right; FIRE where
// `fire` is above the threshold. Its direction is the one of 9 whose components are above the threshold, and
// the radius is the strength of a paddle (docs/spec/environment.md, 15).
Act act_of(float radius, float angle, float fire, float threshold);

}  // namespace racebeam
