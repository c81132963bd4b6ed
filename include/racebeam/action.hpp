// The actions of a player: 18 of a joystick and its button, 8 of the switches of the console, and those of
// other controllers, which a game file names. It consists of values and constant tables, which any number of
// threads may use at the same time.
//
//     const racebeam::Action action = racebeam::Action::kUpFire;
//     std::cout << racebeam::name_of(action) << '\n';  // UPFIRE
//     const auto found = racebeam::action_named("RIGHT");
//     return found == racebeam::Action::kRight ? 0 : 1;
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "racebeam/config.hpp"

namespace RACEBEAM_NAMESPACE {

// The first 18 numbers are those of the Arcade Learning Environment, which does not have the others.
enum class Action : std::uint8_t {
  kNoop,
  kFire,
  kUp,
  kRight,
  kLeft,
  kDown,
  kUpRight,
  kUpLeft,
  kDownRight,
  kDownLeft,
  kUpFire,
  kRightFire,
  kLeftFire,
  kDownFire,
  kUpRightFire,
  kUpLeftFire,
  kDownRightFire,
  kDownLeftFire,
  kReset,   // held during the step
  kSelect,  // held during the step
  kLeftA,   // the left difficulty switch, which keeps its position until the next reset
  kLeftB,
  kRightA,
  kRightB,
  kColor,
  kBlackAndWhite,
  kKey1,  // the keys of a keyboard
  kKey2,
  kKey3,
  kKey4,
  kKey5,
  kKey6,
  kKey7,
  kKey8,
  kKey9,
  kKeyStar,
  kKey0,
  kKeyHash
};

// Buttons of a Genesis pad (kC) and of a booster grip, which a joystick does not have.
enum class Buttons : std::uint8_t { kC = 64, kTrigger = 96, kBooster = 128, kTriggerAndBooster = 160 };

// Returns the action that presses these buttons together with an action of a joystick, one of the first 18.
constexpr Action with(Action joystick, Buttons more) noexcept {
  return static_cast<Action>(static_cast<unsigned>(joystick) + static_cast<unsigned>(more));
}

inline constexpr int kActions = 18;         // how many a joystick has, its button included
inline constexpr int kConsoleActions = 26;  // how many a joystick and the console have

// Returns the name of an action, such as "UPFIRE"; empty for a number that is not an action.
RACEBEAM_API std::string_view name_of(Action action) noexcept;

// Returns the action with this name, in upper case; nothing if the name is unknown.
RACEBEAM_API std::optional<Action> action_named(std::string_view name) noexcept;

// The actions of both players in one step. Only player A can use those of the console. Those of other
// controllers need a game whose file has the controller, such as left = "keyboard".
struct Controls {
  Action a = Action::kNoop, b = Action::kNoop;
  float strength_a = 1, strength_b = 0;  // how far a paddle turns in a frame; 1: its usual step
  int frames = 0;                        // of the step; 0: Settings::frame_skip
};

}  // namespace RACEBEAM_NAMESPACE
