// Fixed work and its output as text: a machine plays random actions, and each line is a digest of some acts.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

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

// A state in its portable form, with the generator, after half of the acts; and the lines of the second half,
// with the CRC-32 of the final state.
struct Halves {
  std::vector<std::uint8_t> state;
  std::string rest;
};
Halves played_in_halves(const Work& work);

// `rest` as a machine shows it that restores `state`.
std::string continued(const Work& work, std::span<const std::uint8_t> state);

}  // namespace racebeam::test
