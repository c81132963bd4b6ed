// The user's settings for a cartridge's console, which override what is known about the image.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "emulator/state/properties.hpp"
#include "system/words.hpp"

namespace racebeam {

// The names in settings.
inline constexpr std::array<WordFor<Controller>, 12> kControllers = {
    {{"joystick", Controller::kJoystick},
     {"paddles", Controller::kPaddles},
     {"keyboard", Controller::kKeyboard},
     {"driving", Controller::kDriving},
     {"booster", Controller::kBooster},
     {"genesis", Controller::kGenesis},
     {"light_gun", Controller::kLightGun},
     {"trackball", Controller::kTrackball},
     {"atari_mouse", Controller::kAtariMouse},
     {"amiga_mouse", Controller::kAmigaMouse},
     {"none", Controller::kNone},
     {"savekey", Controller::kNone}}};
inline constexpr std::array<WordFor<Format>, 5> kFormats = {{{"auto", Format::kAuto},
                                                             {"ntsc", Format::kNtsc},
                                                             {"pal", Format::kPal},
                                                             {"pal60", Format::kPal60},
                                                             {"secam", Format::kSecam}}};

constexpr std::string_view name_of(Controller controller) { return word_for(kControllers, controller); }
constexpr std::string_view name_of(Format format) { return word_for(kFormats, format); }

// The picture buffer has 300 lines (docs/spec/tia.md, 2), and PAL makes 250 of the usual 210.
inline constexpr int kPictureLines = 300, kLastYStart = kPictureLines - 250, kMinHeight = 100,
                     kMaxHeight = 256;

struct PropertyOverrides {
  std::optional<Controller> left, right;
  std::optional<Format> format;
  std::optional<std::string_view> scheme;  // as Properties::scheme
  std::optional<int> ystart, height;

  // Sets the property `key`: scheme, left, right, format, height or ystart. Throws InvalidInput for another
  // key, or a value that the property does not accept.
  void set(std::string_view key, std::string_view value);

  bool empty() const;  // whether nothing is overridden

  // Returns `properties` with the overrides. Throws InvalidInput if the picture does not fit.
  Properties apply_to(Properties properties) const;
};

// A scheme's name in one word: "F8_swapped".
std::string scheme_word(std::string_view name);

}  // namespace racebeam
