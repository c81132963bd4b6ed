// The positions of all controllers and console switches. Part of the machine's state.
#pragma once

#include <array>
#include <cstdint>

namespace racebeam {

// Bits of Inputs::joystick; a set bit is pressed.
constexpr std::uint8_t kStickUp = 1, kStickDown = 2, kStickLeft = 4, kStickRight = 8, kStickFire = 16;
// Two more buttons: C of a Genesis pad, or the booster grip's trigger; and its booster.
constexpr std::uint8_t kStickSecond = 32, kStickThird = 64;
constexpr std::uint8_t kStickBits = 0x7F;

// Bits of Inputs::switches, as SWCHB has them (docs/spec/riot.md, 6): RESET and SELECT are 1 when released.
constexpr std::uint8_t kSwitchReset = 0x01, kSwitchSelect = 0x02, kSwitchColor = 0x08;
constexpr std::uint8_t kSwitchLeftA = 0x40, kSwitchRightA = 0x80;
constexpr std::uint8_t kSwitchesAtRest = 0x3F;  // all released, both difficulties B, colour

// One axis of a wheel, a ball or a gun: its place at the frame's start, and how far it moves in the frame.
struct Axis {
  static constexpr std::int32_t kPlaces = 1 << 16, kMaxMoved = (1 << 14) - 1;

  std::int32_t place = 0, moved = 0;

  constexpr std::int32_t packed() const { return (place & (kPlaces - 1)) | (moved + kMaxMoved + 1) << 16; }
  static constexpr Axis of(std::int32_t packed) {
    return {packed & (kPlaces - 1), (packed >> 16 & (2 * kMaxMoved + 1)) - kMaxMoved - 1};
  }
};

struct Inputs {
  // Resistance in ohms of paddles 0-3; 0 at power-on. Other controllers have two of these numbers for a
  // player: a keyboard the set of its keys that are pressed, bit 0 for the 1, and the rest two axes.
  std::array<std::int32_t, 4> paddle{};
  std::array<std::uint8_t, 2> joystick{};  // [0] player A, [1] player B; other controllers' buttons, too
  std::uint8_t paddle_fire = 0;            // bit n: the button of paddle n is pressed
  std::uint8_t switches = kSwitchesAtRest;
};

}  // namespace racebeam
