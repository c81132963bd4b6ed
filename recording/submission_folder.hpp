// A submission: a folder with logs of episodes and their table, which `racebeam verify` confirms
// (docs/evaluation.md, "Submissions and the board").
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "recording/atomic_file.hpp"
#include "recording/episode_log.hpp"

namespace racebeam {

struct AboutAgent {  // agent.toml
  std::string agent = "agent", version = "1";
  std::int64_t training_frames = 0;
  std::string phrase, role, link;  // empty: agent.toml lacks the key
  bool operator==(const AboutAgent&) const = default;
};

constexpr std::size_t kMaxAgentName = 64;                         // letters, also of a version
constexpr std::size_t kMaxUnitName = 100;                         // GAME-AGENT-TRIAL; also of an episode
constexpr std::int64_t kMaxTrainingFrames = 999'999'999'999'999;  // the board accepts as many
constexpr std::array<std::string_view, 3> kAgentRoles = {"learner", "planner", "baseline"};

// Whether a name is that of a file, and leads nowhere else; and the rule as errors state it.
bool is_plain_name(std::string_view name, std::size_t most_letters);
std::string plain_name_rule(std::size_t most_letters);

// The unit whose episodes are added.
struct SubmissionOrder {
  std::string path;  // of the folder
  AboutAgent about;
  std::string unit;      // GAME-AGENT-TRIAL
  std::string settings;  // of its logs, without the seed: settings_without_seed()
};

// The evaluation preset of a log's settings (docs/experiments.md), or "other". `settings` has every word
// except the seed.
std::string_view preset_of(std::string_view settings);

// Several programs may add their units to a folder at the same time.
class SubmissionFolder {
 public:
  // Creates the folder, or continues one that has the same agent.toml and logs with the same settings. The
  // unit must be new. Throws BudgetSpent, or std::runtime_error with a sentence. A folder that could not be
  // completed is then removed.
  SubmissionFolder(SubmissionOrder order, DiskBudget& budget);
  ~SubmissionFolder();  // removes a unit without logs
  SubmissionFolder(const SubmissionFolder&) = delete;
  SubmissionFolder& operator=(const SubmissionFolder&) = delete;

  // Writes the log and its row, or neither. Throws like the constructor.
  void add(const EpisodeLog& log);

 private:
  void check_earlier(std::string_view text) const;  // `text`: what agent.toml must have
  void check_settings() const;
  std::string unit_path() const { return order_.path + "/logs/" + order_.unit; }
  std::string table_path() const { return order_.path + "/results.csv"; }

  const SubmissionOrder order_;
  DiskBudget& budget_;
};

}  // namespace racebeam
