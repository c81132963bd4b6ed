// Actions to play, read from a trace or from a list of numbers.
#pragma once

#include <string>
#include <vector>

namespace racebeam {

struct ScriptedAction {
  int action;
  int line;  // where it stands, for messages
};

// `path`: a file, plain or gzip, or - for standard input. Lines `A ACTION ...` give one action each; lines
// that begin with #, R or S (the rest of a trace) give none; all other lines are numbers, any count of them.
// Throws std::invalid_argument, naming the line, for anything else, and when the file can't be read.
std::vector<ScriptedAction> read_actions(const std::string& path);

}  // namespace racebeam
