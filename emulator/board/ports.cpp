#include "emulator/board/ports.hpp"

#include <utility>

namespace racebeam {
namespace {

constexpr unsigned kPots = 4;  // INPT0-3; INPT4 and INPT5 are the buttons of joysticks
constexpr std::uint8_t kDirections = kStickUp | kStickDown | kStickLeft | kStickRight;

// Cycles until the capacitor behind a paddle of `ohms` is charged.
std::uint32_t charge_cycles(std::int32_t ohms) {
  return static_cast<std::uint32_t>(((1.6 * ohms) * 0.01e-6) * 1.19e6);
}

}  // namespace

Ports::Ports(const Properties& properties)
    : side_{Port{properties.left, 0}, Port{properties.right, 1}},
      swap_paddles_(properties.swap_paddles ? 1 : 0) {
  if (properties.swap_ports) std::swap(side_[0], side_[1]);
}

std::uint8_t Ports::swcha(const Inputs& inputs) const {
  return static_cast<std::uint8_t>(nibble(inputs, side_[0]) << 4 | nibble(inputs, side_[1]));
}

// Pins 4 to 1: a stick's right, left, down and up; for paddles, only the two buttons.
std::uint8_t Ports::nibble(const Inputs& inputs, const Port& port) const {
  if (port.controller == Controller::kJoystick) {
    const std::uint8_t pressed = inputs.joystick[static_cast<std::size_t>(port.player)] & kDirections;
    return static_cast<std::uint8_t>(~pressed & 0x0F);
  }
  const int first = inputs.paddle_fire >> paddle(port, 0) & 1;
  const int second = inputs.paddle_fire >> paddle(port, 1) & 1;
  return static_cast<std::uint8_t>(~(first << 3 | second << 2) & 0x0F);
}

bool Ports::button_released(const Inputs& inputs, const Port& port) const {
  if (port.controller != Controller::kJoystick) return true;
  return (inputs.joystick[static_cast<std::size_t>(port.player)] & kStickFire) == 0;
}

std::uint32_t Ports::high_from(unsigned pin, const Inputs& inputs, const FrameState& frame) const {
  if (pin >= kPots) return button_released(inputs, side_[pin - kPots]) ? kAlways : kNever;
  const Port& port = side_[pin / 2];
  if (port.controller == Controller::kJoystick) return kNever;
  const std::int32_t ohms = inputs.paddle[static_cast<std::size_t>(paddle(port, pin % 2))];
  if (ohms == 0) return kAlways;
  if (frame.dumping) return kNever;
  // Unsigned on purpose: a release in an earlier frame becomes a huge number, which is never reached
  // (docs/spec/tia.md, 11).
  const std::uint32_t charged = frame.dump_release + charge_cycles(ohms);
  return charged == kNever ? kNever : charged + 1;
}

}  // namespace racebeam
