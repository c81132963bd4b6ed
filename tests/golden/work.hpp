// Fixed work, and what it showed as text: a machine plays by random actions, and each line folds some of its
// acts.
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

// Plays, and gives a line for every `acts_a_line` acts: the number of acts so far, CRC-32 of all screens,
// RAMs and blocks of sound of these acts, the sum of rewards, the lives after the last, and how many episodes
// ended. with_state: and a last line with the CRC-32 of the state at the end, in its portable form.
std::string played(const Work& work, bool with_state = false);

}  // namespace racebeam::test
