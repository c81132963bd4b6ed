// Settings from four sources. The options of a subcommand are the one table of settings: --max-states is also
// the environment variable RACEBEAM_MAX_STATES, and the key max_states of a TOML file.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace racebeam {

enum class Source { kCommandLine, kEnvironment, kFile, kDefault };

struct Setting {
  const CLI::Option* option;
  Source source;
  std::vector<std::string> values;  // as text; empty: not set
};

std::string key_of(const CLI::Option& option);       // max_states
std::string variable_of(const CLI::Option& option);  // RACEBEAM_MAX_STATES
std::string describe(Source source);                 // for messages

// Call it after the command line was parsed. An option that the command line does not set gets the value of
// its environment variable, else of the file, else its default. The file is that of the subcommand's option
// --config. Throws CLI::ValidationError, with a sentence, for values that an option refuses and for unknown
// keys.
std::vector<Setting> complete(CLI::App& command);

}  // namespace racebeam
