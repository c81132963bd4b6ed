// Settings from four sources. The options of a subcommand are the one table of settings: --max-states is also
// the environment variable RACEBEAM_MAX_STATES, and the key max_states of a TOML file.
#pragma once

#include <string>
#include <vector>

namespace racebeam {

class Subcommand;

enum class Source { kCommandLine, kEnvironment, kFile, kDefault };

struct Setting {
  std::string key;  // max_states
  bool is_list;
  Source source;
  std::vector<std::string> values;  // as text; empty: not set

  std::string name() const;  // --max-states
};

std::string describe(Source source);  // for messages

bool is_default(const std::vector<Setting>& settings, const std::string& key);

// Call it after the command line was parsed. An option that the command line does not set gets the value of
// its environment variable, else of the file, else its default. The file is that of the subcommand's option
// --config. Throws UsageError for values that an option refuses and for unknown
// keys.
std::vector<Setting> complete(Subcommand command);

}  // namespace racebeam
