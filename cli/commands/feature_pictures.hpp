// The pictures of appendix A of the paper: what the feature sets see of a screen. Each is 160 x 210 pixels,
// written as a PNG file.
#pragma once

#include <string>
#include <vector>

#include "agents/features/object_classes.hpp"

namespace racebeam {

using Colours = std::vector<std::uint8_t>;  // palette indices of 160 x 210 pixels

// The last screen of some random play, and the one before.
struct ScreenPair {
  Colours before, last;
};
ScreenPair sample_screen(const Cartridge& cartridge, const SampleSettings& settings);

void draw_background(const std::string& path, const Background& background);
void draw_in_secam(const std::string& path, const Colours& screen);

// The tiles of BASS, each in stripes of the colours that are in it.
void draw_tiles(const std::string& path, const Background& background, const Colours& screen);

// A band for each class, with its most frequent shapes, in its own colour.
void draw_classes(const std::string& path, const ObjectClasses& classes);

// The screen in grey, and the objects that are found on it in the colours of their classes.
void draw_objects(const std::string& path, const Background& background, const ObjectClasses& classes,
                  const ScreenPair& screens, int reach);

}  // namespace racebeam
