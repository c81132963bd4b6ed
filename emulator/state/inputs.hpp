// The positions of all controllers and console switches. Part of the machine's state.
#pragma once

#include <array>
#include <cstdint>

namespace racebeam {

// Bits of Inputs::joystick; a set bit is pressed.
constexpr std::uint8_t kStickUp = 1, kStickDown = 2, kStickLeft = 4, kStickRight = 8, kStickFire = 16;

// Bits of Inputs::switches, as SWCHB has them (docs/spec/riot.md, 6): RESET and SELECT are 1 when released.
constexpr std::uint8_t kSwitchReset = 0x01, kSwitchSelect = 0x02, kSwitchColor = 0x08;
constexpr std::uint8_t kSwitchLeftA = 0x40, kSwitchRightA = 0x80;
constexpr std::uint8_t kSwitchesAtRest = 0x3F;  // all released, both difficulties B, colour

struct Inputs {
  std::array<std::int32_t, 4> paddle{};    // resistance in ohms of paddles 0-3; 0 at power-on
  std::array<std::uint8_t, 2> joystick{};  // [0] player A, [1] player B
  std::uint8_t paddle_fire = 0;            // bit n: the button of paddle n is pressed
  std::uint8_t switches = kSwitchesAtRest;
};

}  // namespace racebeam
