// Reads the actions to play from a trace or a list of numbers.
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
  int line;                            // in the file, for messages
  int action = 0;                      // player A's
  float strength = 1;                  // how far a paddle turns
  std::optional<RamWrite> write = {};  // instead of an action
};

// Reads `path`: a file, plain or gzip, or - for standard input. An action is a number, or NUMBER@STRENGTH. A
// line `A ACTION ...` is one action, and a line `M INDEX VALUE ...` writes a byte of RAM. Lines that begin
// with #, R or S (the rest of a trace) are skipped. Other lines hold any number of actions. Throws
// std::invalid_argument, with the line, for anything else, and if the file cannot be read.
std::vector<ScriptedStep> read_script(const std::string& path);

// Reads actions only: writes and strengths are refused.
std::vector<int> read_actions(const std::string& path);

}  // namespace racebeam
