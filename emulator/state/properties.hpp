// What a console must be told about a cartridge that its bytes do not say: controllers, picture window, format.
// The defaults are those of the reference for an image that it has no entry for (docs/spec/cartridges.md, 3).
#pragma once

#include <cstdint>
#include <string_view>

namespace racebeam {

enum class Controller : std::uint8_t { kJoystick, kPaddles };

// The television standard. kAuto: run 60 frames and look how many of them are long (docs/spec/console.md, 1).
enum class Format : std::uint8_t { kAuto, kNtsc, kPal, kPal60, kSecam };

struct Properties {
  Controller left = Controller::kJoystick;
  Controller right = Controller::kJoystick;
  bool swap_ports = false;        // the left controller is plugged into the right port and the other way round
  bool swap_paddles = false;      // the two paddles of a port exchange roles
  bool left_difficulty_a = false; // switch position while the format is being detected
  bool right_difficulty_a = false;
  bool hmove_blanks = true;       // HMOVE leaves its comb of eight black pixels
  Format format = Format::kAuto;
  std::string_view scheme{};      // of the cartridge, a name of scheme_names(); empty: detected
  int ystart = 34;                // first line of the picture
  int height = 210;               // lines of the picture; 210 becomes 250 for PAL and SECAM

  bool operator==(const Properties&) const = default;
};

}  // namespace racebeam
