// Plays Beamfall in this process, and prints the version, the sum of the rewards and the frames.
#include <iostream>
#include <racebeam/racebeam.hpp>

int main() {
  racebeam::Settings settings;
  settings.seed = 7;
  settings.frame_skip = 4;
  settings.sticky = 0;
  racebeam::Environment environment(racebeam::Image::load("builtin:beamfall"), settings);
  int score = 0;
  for (int step = 0; step < 100; ++step) score += environment.step(racebeam::Action::kFire);
  try {
    environment.set_mode(-1);  // an exception passes from a shared library to its program
  } catch (const racebeam::Error&) {
    std::cout << RACEBEAM_VERSION_STRING << ' ' << score << ' ' << environment.episode_frames() << '\n';
  }
}
