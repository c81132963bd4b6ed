// Every state of a run restores to what it was, wherever it is restored.
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
  int ahead = 200;  // frames that each is compared for
  std::uint64_t seed = 1;
  std::string executable;  // of the fresh processes; see resume()
};

// Plays `cartridge` in manner(number); saves the state at every frame; then restores each, compares what is
// shown and goes on, comparing with what the run itself showed: on the machine that ran, on a machine made
// anew after the same place in memory ran `other`, and in a process of its own. An empty string, or what
// differed first.
std::string check_run(const Cartridge& cartridge, const Cartridge& other, int number, const Plan& plan);

// What a fresh process does: restores the state in FOLDER/state on the image FOLDER/image, and prints the
// digests of the present and of the acts after it, one a line.
struct Resumption {
  std::string folder, game;
  int manner = 0, first = 0, acts = 0;
  std::uint64_t seed = 0;
};
void resume(const Resumption& resumption);

}  // namespace racebeam::test
