#include "environment/input/controller_input.hpp"

#include "games/game/actions.hpp"

namespace racebeam {
namespace {

constexpr std::array<std::uint8_t, kActions> kSticks = {
    0,
    kStickFire,
    kStickUp,
    kStickRight,
    kStickLeft,
    kStickDown,
    kStickUp | kStickRight,
    kStickUp | kStickLeft,
    kStickDown | kStickRight,
    kStickDown | kStickLeft,
    kStickUp | kStickFire,
    kStickRight | kStickFire,
    kStickLeft | kStickFire,
    kStickDown | kStickFire,
    kStickUp | kStickRight | kStickFire,
    kStickUp | kStickLeft | kStickFire,
    kStickDown | kStickRight | kStickFire,
    kStickDown | kStickLeft | kStickFire,
};

// The bits of a joystick. first: the number of the player's NOOP.
std::uint8_t stick(std::int32_t action, std::int32_t first) {
  const bool is_known = action >= first && action < first + kActions;
  return is_known ? kSticks[static_cast<std::size_t>(action - first)] : std::uint8_t{0};
}

int direction(std::uint8_t pressed) {
  if ((pressed & kStickRight) != 0) return -1;
  return (pressed & kStickLeft) != 0 ? 1 : 0;
}

void release_all(Inputs& inputs, const ConsoleSwitches& switches) {
  const int positions = switches.positions();
  inputs.joystick = {};
  inputs.paddle_fire = 0;
  inputs.switches = kSwitchesAtRest;
  if ((positions & ConsoleSwitches::kLeftA) != 0) inputs.switches |= kSwitchLeftA;
  if ((positions & ConsoleSwitches::kRightA) != 0) inputs.switches |= kSwitchRightA;
  if ((positions & ConsoleSwitches::kBlackAndWhite) != 0) inputs.switches ^= kSwitchColor;
}

void hold(Inputs& inputs, std::uint8_t console_switch) {
  inputs.switches &= static_cast<std::uint8_t>(~console_switch);
}

}  // namespace

void ControllerInput::press(Inputs& inputs, const Presses& presses, const ConsoleSwitches& switches,
                            PaddleValues& paddles) const {
  release_all(inputs, switches);
  if (presses.a.action == kResetAction) hold(inputs, kSwitchReset);
  if (presses.a.action == kSelectAction) hold(inputs, kSwitchSelect);
  if (use_paddles_) return turn_paddles(inputs, presses, paddles);
  inputs.joystick = {stick(presses.a.action, 0), stick(presses.b.action, kActions)};
}

void ControllerInput::turn_paddles(Inputs& inputs, const Presses& presses, PaddleValues& paddles) const {
  const std::uint8_t a = stick(presses.a.action, 0), b = stick(presses.b.action, kActions);
  paddles = {limits_.turn(paddles[0], direction(a), presses.a.strength),
             limits_.turn(paddles[1], direction(b), presses.b.strength)};
  inputs.paddle[0] = paddles[0];
  inputs.paddle[1] = paddles[1];
  inputs.paddle_fire =
      static_cast<std::uint8_t>(((a & kStickFire) != 0 ? 1 : 0) | ((b & kStickFire) != 0 ? 2 : 0));
}

void ControllerInput::press_select(Inputs& inputs, const ConsoleSwitches& switches) {
  release_all(inputs, switches);
  hold(inputs, kSwitchSelect);
}

}  // namespace racebeam
