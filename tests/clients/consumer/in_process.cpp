// Plays Beamfall in this process, and prints the version, the sum of the rewards and the frames.
#include <iostream>

#include "environment/environment.hpp"
#include "games/catalogue.hpp"
#include "version.hpp"

int main() {
  const auto image = racebeam::load_image("builtin:beamfall");
  racebeam::Settings settings;
  settings.random_seed = 7;
  settings.frame_skip = 4;
  settings.sticky = 0;
  racebeam::Environment machine(image, racebeam::recognise(*image).game, settings);
  constexpr int kFire = 1;
  int score = 0;
  for (int act = 0; act < 100; ++act) score += machine.act(kFire);
  std::cout << RACEBEAM_VERSION_STRING << ' ' << score << ' ' << machine.frame_number() << '\n';
}
