// The properties of a cartridge that a console needs beyond its bytes: controllers, picture window, format.
// The defaults are the reference's, for an image without an entry (docs/spec/cartridges.md, 3).
#pragma once

#include <cstdint>
#include <string_view>

namespace racebeam {

// docs/spec/controllers.md. kNone: nothing that answers, such as a missing SaveKey.
enum class Controller : std::uint8_t {
  kJoystick,
  kPaddles,
  kKeyboard,
  kDriving,
  kBooster,
  kGenesis,
  kLightGun,
  kTrackball,
  kAtariMouse,
  kAmigaMouse,
  kNone
};

// The television standard. kAuto: 60 frames are run, and the long ones counted (docs/spec/console.md, 1).
enum class Format : std::uint8_t { kAuto, kNtsc, kPal, kPal60, kSecam };

struct Properties {
  Controller left = Controller::kJoystick;
  Controller right = Controller::kJoystick;
  bool swap_ports = false;         // the left controller is in the right port, and the reverse
  bool swap_paddles = false;       // the two paddles of a port exchange roles
  bool left_difficulty_a = false;  // switch position while the format is being detected
  bool right_difficulty_a = false;
  bool hmove_blanks = true;  // whether HMOVE leaves its comb of eight black pixels
  Format format = Format::kAuto;
  std::string_view scheme{};  // name of the cartridge scheme, from scheme_names(); empty: detected
  int ystart = 34;            // first line of the picture
  int height = 210;           // lines of the picture; 210 becomes 250 for PAL and SECAM

  bool operator==(const Properties&) const = default;
};

}  // namespace racebeam
