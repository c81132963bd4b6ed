// What a user says about a cartridge's console, instead of what is known of the image.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "emulator/state/properties.hpp"

namespace racebeam {

// The names in files and settings, as Controller and Format count.
inline constexpr std::array<std::string_view, 2> kControllerNames = {"joystick", "paddles"};
inline constexpr std::array<std::string_view, 5> kFormatNames = {"auto", "ntsc", "pal", "pal60", "secam"};

inline std::string_view name_of(Controller controller) {
  return kControllerNames[static_cast<std::size_t>(controller)];
}

// The picture buffer has 300 lines (docs/spec/tia.md, 2), and PAL makes 250 of the usual 210.
inline constexpr int kPictureLines = 300, kLastYStart = kPictureLines - 250, kLeastHeight = 100,
                     kMostHeight = 256;

struct GivenProperties {
  std::optional<Controller> left, right;
  std::optional<Format> format;
  std::optional<std::string_view> scheme;  // as Properties::scheme
  std::optional<int> ystart, height;

  // Reads one of scheme, left, right, format, height and ystart. Throws InvalidInput for another key, or a
  // value that the key does not take.
  void give(std::string_view key, std::string_view value);

  bool empty() const;
  Properties in(Properties properties) const;  // throws InvalidInput if the picture does not fit
};

// A scheme's name in one word: "F8_swapped".
std::string scheme_word(std::string_view name);

}  // namespace racebeam
