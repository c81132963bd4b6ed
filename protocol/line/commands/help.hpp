// The texts of `help`: lines that are made from the tables.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

struct HelpText {
  std::string head;
  std::vector<std::string> entries;
};

struct HelpTopic {
  std::string_view name;
  HelpText (*text)();
};
std::span<const HelpTopic> help_topics();

HelpText help();  // an overview

// Help on a topic, a command, a setting, a field, a preset, an encoding, an error code, or a word of a
// command's arguments. Throws RequestError.
HelpText help_on(std::string_view name);

// Writes one line. With `columns` above 0, writes for a terminal of that width: one entry a line, and longer
// entries folded.
void append_help(std::string& out, const HelpText& help, int columns);

}  // namespace racebeam
