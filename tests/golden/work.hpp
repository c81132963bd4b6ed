// Fixed work and its output as text: a machine plays random actions, and each line is a digest of some acts.
#pragma once

#include <memory>
#include <string>

#include "environment/environment.hpp"

namespace racebeam::test {

struct Work {
  std::string name;  // of the setting, or of the program
  std::shared_ptr<const Image> image;
  std::shared_ptr<const Game> game;
  Settings settings;
  int mode = 0, difficulty = 0;
  int acts = 0, acts_a_line = 0;
};

// The header of the columns.
extern const std::string kColumns;

// Plays, and returns a line for every `acts_a_line` acts. It has the number of acts so far, CRC-32s of all
// screens, RAMs and blocks of sound, the sum of rewards, the lives after the last act, and the number of
// ended episodes. with_state: adds a line with the CRC-32 of the final state in its portable form.
std::string played(const Work& work, bool with_state = false);

}  // namespace racebeam::test
