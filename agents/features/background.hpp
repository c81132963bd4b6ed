// The still part of a game's screen: the most frequent colour of each pixel (docs/paper-notes.md,
// "Features").
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "agents/features/screen.hpp"
#include "environment/settings/play_settings.hpp"
#include "games/catalogue.hpp"

namespace racebeam {

// From which screens something is discovered.
struct SampleSettings {
  std::uint32_t seed = 1;
  int background_screens = 18000, class_screens = 36000;
  PlaySettings play;  // of these, samples have frame_skip, color_averaging, mode and difficulty
  // The SHA-256 of the CSV file that the background is from; empty: it is discovered.
  std::string background_csv = {};
  std::string version = {};  // of the program
};

// Calls `look` with this many screens of sample trajectories; `first` says that a new one begins. Each begins
// with a random number of decisions of a Perturb policy, whose screens are not looked at, and goes on with
// random actions. What is discovered depends on nothing that its file does not name (game_facts.cpp), so that
// the machine has no sticky actions, and no limit of frames, whatever the settings say.
using LookAtScreen = std::function<void(const Environment& environment, bool first)>;
void sample_screens(const Cartridge& cartridge, const SampleSettings& settings, int screens,
                    std::uint64_t seed, const LookAtScreen& look);

// A colour, from 0 to 127, for each pixel.
using Background = std::array<std::uint8_t, kFeaturePixels>;

class ColourHistogram {
 public:
  ColourHistogram();
  void add(Screen screen);
  Background most_frequent() const;  // the lowest of equals

 private:
  std::vector<std::uint32_t> counts_;  // pixel by pixel, of each colour
};

Background discover_background(const Cartridge& cartridge, const SampleSettings& settings);

// 210 lines of 160 colours. Throws InvalidInput, naming `name`, for another size and for other values.
Background background_of_csv(const std::string& name, std::string_view text);
std::string csv_of(const Background& background);

}  // namespace racebeam
