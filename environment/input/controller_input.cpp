#include "environment/input/controller_input.hpp"

#include <algorithm>
#include <cmath>

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

// The buttons that an action has besides those of a joystick.
std::uint8_t more_buttons(std::int32_t action) {
  if (action >= kWithBoth) return kStickSecond | kStickThird;
  return action >= kWithBooster ? kStickThird : kStickSecond;
}

constexpr bool has_buttons(Controller controller) {
  return controller == Controller::kGenesis || controller == Controller::kBooster;
}

// The bits of a joystick. first: the number of the player's NOOP.
std::uint8_t stick(std::int32_t action, std::int32_t first, Controller controller) {
  const std::int32_t own = action - first;
  if (own >= 0 && own < kActions) return kSticks[static_cast<std::size_t>(own)];
  if (!has_buttons(controller) || !has_more_buttons(own)) return 0;
  return kSticks[static_cast<std::size_t>(own % kButtonActions)] | more_buttons(own);
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

// The controllers with numbers of their own in Inputs, which are not resistances.

constexpr float kOneMove = 1, kMaxMoves = 127;  // of a wheel and a ball in a frame
constexpr std::int32_t kGunStep = 2, kGunMiddleX = 80, kGunMiddleY = 105;
constexpr std::int32_t kPlaceStep = 256, kMaxPlace = 256 * 256;  // a place is x + 256 * y
constexpr std::int32_t kLastX = 159, kLastY = 255;

constexpr bool has_axes(Controller controller) {
  switch (controller) {
    case Controller::kDriving:
    case Controller::kLightGun:
    case Controller::kTrackball:
    case Controller::kAtariMouse:
    case Controller::kAmigaMouse: return true;
    default: return false;
  }
}

// What an environment keeps of both axes of a player between two frames.
struct Place {
  std::int32_t x, y;

  static Place of(std::int32_t kept) { return {kept & 0xFFFF, kept >> 16}; }
  std::int32_t kept() const { return (x & 0xFFFF) | (y & 0x7FFF) << 16; }
};

std::int32_t way(std::uint8_t pressed, std::uint8_t forward, std::uint8_t back) {
  return ((pressed & forward) != 0 ? 1 : 0) - ((pressed & back) != 0 ? 1 : 0);
}

// A place that the action says, or the old one, moved by the stick.
Place aimed(Place place, std::uint8_t pressed, float strength) {
  if (strength >= kPlaceStep && strength < kMaxPlace) {
    const auto number = static_cast<std::int32_t>(strength);
    place = {number % kPlaceStep, number / kPlaceStep};
  } else {
    place.x += kGunStep * way(pressed, kStickRight, kStickLeft);
    place.y += kGunStep * way(pressed, kStickDown, kStickUp);
  }
  return {std::clamp(place.x, 0, kLastX), std::clamp(place.y, 0, kLastY)};
}

struct Axes {
  Axis x, y;
};

Axes moved(Controller controller, std::uint8_t pressed, float strength, std::int32_t& kept) {
  const Place place = Place::of(kept);
  if (controller == Controller::kLightGun) {
    const Place there = aimed(place, pressed, strength);
    kept = there.kept();
    return {{there.x, 0}, {there.y, 0}};
  }
  const float most = controller == Controller::kDriving ? kOneMove : kMaxMoves;
  const auto moves = static_cast<std::int32_t>(std::min(std::fabs(strength), most));
  const std::int32_t x = moves * way(pressed, kStickRight, kStickLeft),
                     y = moves * way(pressed, kStickDown, kStickUp);
  kept = Place{place.x + x, place.y + y}.kept();
  return {{place.x, x}, {place.y, y}};
}

void operate(Inputs& inputs, std::size_t player, Controller controller, const Press& press,
             std::int32_t& kept) {
  const std::int32_t first = player == 0 ? 0 : kActions, own = press.action - first;
  std::int32_t* const numbers = &inputs.paddle[2 * player];
  if (controller == Controller::kKeyboard) {
    numbers[0] = is_key(own) ? 1 << (own - kFirstKey) : 0;
  } else if (has_axes(controller)) {
    const Axes axes = moved(controller, stick(press.action, first, controller), press.strength, kept);
    numbers[0] = axes.x.packed();
    numbers[1] = axes.y.packed();
  }
}

}  // namespace

PaddleValues ControllerInput::middle() const {
  PaddleValues values = limits_.middle();
  for (std::size_t player = 0; player < values.size(); ++player)
    if (has_axes(controllers_[player]))
      values[player] =
          controllers_[player] == Controller::kLightGun ? Place{kGunMiddleX, kGunMiddleY}.kept() : 0;
  return values;
}

void ControllerInput::press(Inputs& inputs, const Presses& presses, const ConsoleSwitches& switches,
                            PaddleValues& paddles) const {
  release_all(inputs, switches);
  if (presses.a.action == kResetAction) hold(inputs, kSwitchReset);
  if (presses.a.action == kSelectAction) hold(inputs, kSwitchSelect);
  if (use_paddles())
    turn_paddles(inputs, presses, paddles);
  else
    inputs.joystick = {stick(presses.a.action, 0, controllers_[0]),
                       stick(presses.b.action, kActions, controllers_[1])};
  operate(inputs, 0, controllers_[0], presses.a, paddles[0]);
  operate(inputs, 1, controllers_[1], presses.b, paddles[1]);
}

void ControllerInput::turn_paddles(Inputs& inputs, const Presses& presses, PaddleValues& paddles) const {
  const std::uint8_t a = stick(presses.a.action, 0, controllers_[0]),
                     b = stick(presses.b.action, kActions, controllers_[1]);
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
