// Settings from four places. The options of a subcommand are the one table of settings: --max-states is also
// the environment variable RACEBEAM_MAX_STATES and the key max_states of a TOML file.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace racebeam {

enum class Source { kCommandLine, kEnvironment, kFile, kDefault };

struct Setting {
  const CLI::Option* option;
  Source source;
  std::vector<std::string> values;  // as text; none: not set
};

std::string key_of(const CLI::Option& option);       // max_states
std::string variable_of(const CLI::Option& option);  // RACEBEAM_MAX_STATES
std::string describe(Source source);                 // for people

// To be called after the command line was parsed: gives each option that it has left out the value of its
// environment variable, else of the file; what is in neither keeps its default. The file is that of the
// option
// --config, which the subcommand has. Throws CLI::ValidationError, with a sentence, for values that an option
// refuses and for keys that are none.
std::vector<Setting> complete(CLI::App& command);

}  // namespace racebeam
