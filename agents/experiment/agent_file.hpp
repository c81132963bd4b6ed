// agent.toml of a submission (docs/evaluation.md, "Submissions and the board"). The board has the same rules,
// in evaluation/racebeam_evaluation/board/agent_file.py.
#pragma once

#include <optional>
#include <string>

namespace racebeam {

// What agent.toml says of the rows and their logs.
struct AgentFile {
  std::string agent, preset;
  std::optional<std::string> phrase;
};

// Checks all keys. Throws InvalidInput with a sentence that names the file, the key and the value.
AgentFile read_agent_file(const std::string& path);

}  // namespace racebeam
