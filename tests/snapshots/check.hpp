// Every state of a run can be restored, on any machine and in any process.
#pragma once

#include <memory>
#include <string>

#include "games/game/game.hpp"
#include "games/rom_image.hpp"

namespace racebeam::test {

struct Cartridge {
  std::shared_ptr<const Image> image;
  std::shared_ptr<const Game> game;
  bool own = false;  // one of our games, whose image is built in
};

struct Plan {
  int frames = 0;   // consecutive frames whose state is saved
  int ahead = 200;  // frames after each state that are compared
  std::uint64_t seed = 1;
  std::string executable;  // of the other processes; see resume()
};

// Plays `cartridge` in manner(number), and saves the state at every frame. Then restores each state, and
// compares its digests, and those of the following acts, with the run's. This is done on the machine that
// ran, on a machine in the same memory after another ran `other`, and in another process. Returns the first
// difference, or an empty string.
std::string check_run(const Cartridge& cartridge, const Cartridge& other, int number, const Plan& plan);

// The work of another process: restores the state in FOLDER/state with the image FOLDER/image. Prints the
// digests of the present and of the following acts, one a line.
struct Resumption {
  std::string folder, game;
  int manner = 0, first = 0, acts = 0;
  std::uint64_t seed = 0;
};
void resume(const Resumption& resumption);

}  // namespace racebeam::test
