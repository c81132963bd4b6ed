#include "emulator/board/ports.hpp"

#include <algorithm>
#include <utility>

#include "emulator/tia/beam.hpp"
#include "emulator/tia/registers/motion.hpp"

namespace racebeam {
namespace {

constexpr unsigned kPots = 4;  // INPT0-3; INPT4 and INPT5 are the buttons of joysticks
constexpr std::uint8_t kDirections = kStickUp | kStickDown | kStickLeft | kStickRight;
constexpr std::uint8_t kAllHigh = 0x0F;
constexpr unsigned kRows = 4, kColumns = 3;  // of a keyboard
constexpr std::int32_t kFrameCycles = 262 * kLineCycles;

// What a light gun sees: lines around its own, and for how long after the beam has passed.
constexpr std::int32_t kLinesAround = 2, kLitCycles = 16, kClocksPerCycle = 3;

// Cycles until the capacitor behind a paddle of `ohms` is charged.
std::uint32_t charge_cycles(std::int32_t ohms) {
  return static_cast<std::uint32_t>(((1.6 * ohms) * 0.01e-6) * 1.19e6);
}

const std::int32_t& number_of(const Inputs& inputs, int player, int which) {
  return inputs.paddle[static_cast<std::size_t>(2 * player + which)];
}

// Where an axis is in a cycle of the frame, in which it moves evenly.
unsigned place_at(const Inputs& inputs, int player, int which, std::int32_t cycle) {
  const Axis axis = Axis::of(number_of(inputs, player, which));
  const std::int64_t into = std::clamp(cycle, 0, kFrameCycles);
  return static_cast<unsigned>(axis.place + axis.moved * into / kFrameCycles);
}

// Two signals that follow each other by a quarter of a period: which is ahead tells the direction.
unsigned ahead(unsigned place) { return place >> 1 & 1; }
unsigned behind(unsigned place) { return (place + 1) >> 1 & 1; }

// The wheel's code, pins 2 and 1, at four places in a row to the right.
constexpr std::array<std::uint8_t, 4> kWheel = {3, 2, 0, 1};

// Pins 1 to 4 of a trackball: direction and motion of each axis, 1 to the right and down.
unsigned trackball(const Inputs& inputs, int player, unsigned x, unsigned y) {
  const auto forward = [&](int which) { return Axis::of(number_of(inputs, player, which)).moved >= 0; };
  return (forward(0) ? 1U : 0U) | (x & 1) << 1 | (forward(1) ? 4U : 0U) | (y & 1) << 3;
}

unsigned atari_mouse(unsigned x, unsigned y) {  // XB, XA, YA, YB
  return behind(x) | ahead(x) << 1 | ahead(y) << 2 | behind(y) << 3;
}

unsigned amiga_mouse(unsigned x, unsigned y) {  // V, H, VQ, HQ
  return ahead(y) | ahead(x) << 1 | behind(y) << 2 | behind(x) << 3;
}

// The pins that a program drives low are the rows of a keyboard that it looks at.
std::uint8_t rows(unsigned side, const State& state) {
  const unsigned levels = state.frame.swcha | (~state.riot.swacnt & 0xFFU);
  return static_cast<std::uint8_t>(levels >> (side == 0 ? 4 : 0) & kAllHigh);
}

bool key_shows(unsigned side, int player, unsigned column, const State& state) {
  const auto keys = static_cast<unsigned>(number_of(state.inputs, player, 0));
  for (unsigned row = 0; row < kRows; ++row)
    if ((rows(side, state) >> row & 1) == 0 && (keys >> (kColumns * row + column) & 1) != 0) return true;
  return false;
}

std::uint8_t stick(const Inputs& inputs, int player) {
  return inputs.joystick[static_cast<std::size_t>(player)];
}

}  // namespace

Ports::Ports(const Properties& properties)
    : side_{Port{properties.left, 0}, Port{properties.right, 1}},
      swap_paddles_(properties.swap_paddles ? 1 : 0) {
  if (properties.swap_ports) std::swap(side_[0], side_[1]);
}

std::uint8_t Ports::swcha(const State& state, std::int32_t cycle) const {
  return static_cast<std::uint8_t>(nibble(0, state, cycle) << 4 | nibble(1, state, cycle));
}

std::uint8_t Ports::paddle_buttons(const Inputs& inputs, const Port& port) const {
  const int first = inputs.paddle_fire >> paddle(port, 0) & 1;
  const int second = inputs.paddle_fire >> paddle(port, 1) & 1;
  return static_cast<std::uint8_t>(~(first << 3 | second << 2) & kAllHigh);
}

// Pins 4 to 1: a stick's right, left, down and up; for paddles, only the two buttons.
std::uint8_t Ports::nibble(unsigned side, const State& state, std::int32_t cycle) const {
  const Port& port = side_[side];
  if (port.controller == Controller::kJoystick)
    return static_cast<std::uint8_t>(~unsigned{stick(state.inputs, port.player)} & kDirections);
  return port.controller == Controller::kPaddles ? paddle_buttons(state.inputs, port)
                                                 : other_nibble(side, state, cycle);
}

std::uint8_t Ports::other_nibble(unsigned side, const State& state, std::int32_t cycle) const {
  const Port& port = side_[side];
  const Inputs& inputs = state.inputs;
  const auto axis = [&](int which) { return place_at(inputs, port.player, which, cycle); };
  unsigned pins = kAllHigh;
  switch (port.controller) {
    case Controller::kBooster:
    case Controller::kGenesis: pins = ~unsigned{stick(inputs, port.player)} & kDirections; break;
    case Controller::kKeyboard: return rows(side, state);
    case Controller::kDriving: pins = 0x0CU | kWheel[axis(0) % kWheel.size()]; break;
    case Controller::kLightGun:
      pins = 0x0EU | ((stick(inputs, port.player) & kStickFire) != 0 ? 1U : 0U);
      break;
    case Controller::kTrackball: pins = trackball(inputs, port.player, axis(0), axis(1)); break;
    case Controller::kAtariMouse: pins = atari_mouse(axis(0), axis(1)); break;
    case Controller::kAmigaMouse: pins = amiga_mouse(axis(0), axis(1)); break;
    default: break;
  }
  return static_cast<std::uint8_t>(pins);
}

bool Ports::button_released(unsigned side, const State& state) const {
  const Port& port = side_[side];
  switch (port.controller) {
    case Controller::kPaddles:
    case Controller::kLightGun:
    case Controller::kNone: return true;
    case Controller::kKeyboard: return !key_shows(side, port.player, kColumns - 1, state);
    default: return (stick(state.inputs, port.player) & kStickFire) == 0;
  }
}

std::uint32_t Ports::charged_from(unsigned pin, const State& state) const {
  const FrameState& frame = state.frame;
  const Port& port = side_[pin / 2];
  const std::int32_t ohms = state.inputs.paddle[static_cast<std::size_t>(paddle(port, pin % 2))];
  if (ohms == 0) return kAlways;
  if (frame.dumping) return kNever;
  // Unsigned on purpose: a release in an earlier frame becomes a huge number, which is never reached
  // (docs/spec/tia.md, 11).
  const std::uint32_t charged = frame.dump_release + charge_cycles(ohms);
  return charged == kNever ? kNever : charged + 1;
}

// A Genesis pad's C pulls INPT1 down; both buttons of a booster grip pull a pin up.
std::uint32_t Ports::second_button(unsigned pin, const State& state) const {
  const Port& port = side_[pin / 2];
  const std::uint8_t pressed = stick(state.inputs, port.player);
  if (port.controller == Controller::kGenesis)
    return pin % 2 == 1 && (pressed & kStickSecond) != 0 ? kNever : kAlways;
  return (pressed & (pin % 2 == 0 ? kStickSecond : kStickThird)) != 0 ? kAlways : kNever;
}

std::uint32_t Ports::high_from(unsigned pin, const State& state) const {
  if (pin >= kPots) return button_released(pin - kPots, state) ? kAlways : kNever;
  switch (side_[pin / 2].controller) {
    case Controller::kJoystick: return kNever;
    case Controller::kPaddles: return charged_from(pin, state);
    default: return other_pin(pin, state);
  }
}

std::uint32_t Ports::other_pin(unsigned pin, const State& state) const {
  const unsigned side = pin / 2;
  switch (side_[side].controller) {
    case Controller::kGenesis:
    case Controller::kBooster: return state.frame.dumping ? kNever : second_button(pin, state);
    case Controller::kKeyboard: {
      const bool low = state.frame.dumping || key_shows(side, side_[side].player, pin % 2, state);
      return low ? kNever : kAlways;
    }
    default: return kNever;
  }
}

bool Ports::sees_beam(unsigned side, const Inputs& inputs, std::int32_t cycle, std::int32_t origin) const {
  const Port& port = side_[side];
  if (port.controller != Controller::kLightGun) return false;
  const Axis x = Axis::of(number_of(inputs, port.player, 0)), y = Axis::of(number_of(inputs, port.player, 1));
  const std::int32_t passes = origin + kLineCycles * y.place + (kBlankClocks + x.place) / kClocksPerCycle;
  const std::int32_t since = cycle - passes + kLineCycles * kLinesAround;
  return since >= 0 && since < kLineCycles * (2 * kLinesAround + 1) && since % kLineCycles < kLitCycles;
}

}  // namespace racebeam
