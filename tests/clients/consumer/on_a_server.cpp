// Plays the same on a server, the program that RACEBEAM_PROGRAM names.
#include <iostream>
#include <racebeam/client.hpp>
#include <racebeam/version.hpp>

int main() {
  auto game = racebeam::client::launch();
  game.load("beamfall", "seed=7", "frame_skip=4", "sticky=0");
  game.observe("reward", "frame");
  const auto result = game.act("FIRE*100");
  std::cout << RACEBEAM_VERSION_STRING << ' ' << result.reward() << ' ' << result.number("frame") << '\n';
}
