// What to play, read from a trace or from a list of numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace racebeam {

struct RamWrite {
  int index;
  std::uint8_t value;
};

struct ScriptedStep {
  int line;                            // where it stands, for messages
  int action = 0;                      // player A's
  float strength = 1;                  // how far a paddle turns
  std::optional<RamWrite> write = {};  // instead of an action
};

// `path`: a file, plain or gzip, or - for standard input. An action is a number, or NUMBER@STRENGTH. Lines
// `A ACTION ...` give one action each, lines `M INDEX VALUE ...` a byte of RAM to write; lines that begin
// with #, R or S (the rest of a trace) give nothing; all other lines are actions, any count of them.
// Throws std::invalid_argument, naming the line, for anything else, and when the file can't be read.
std::vector<ScriptedStep> read_script(const std::string& path);

// The same for who plays actions alone: writes and strengths are refused.
std::vector<int> read_actions(const std::string& path);

}  // namespace racebeam
