// The table of agents that a plan can name. A new agent is a class, and a row of this table.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "agents/base/agent.hpp"
#include "environment/input/action_set.hpp"
#include "environment/settings/play_settings.hpp"
#include "games/catalogue.hpp"

namespace racebeam {

// A number that a plan can set, or a word of `choices`, whose index is the value.
struct AgentSetting {
  std::string_view name;
  double value;  // the default
  double least, most;
  bool whole = false;
  std::string_view source;  // of the default: the paper's line, or docs/paper-notes.md
  std::span<const std::string_view> choices = {};
  int divides = 0;  // the value must divide this number; 0: it need not
  // Its default is what racebeam did before it had the setting. A plan names it only if it has another value,
  // so that results of earlier plans can be continued.
  bool is_later = false;
};

// The settings of one agent, each with a value within its range.
class AgentValues {
 public:
  AgentValues() = default;
  explicit AgentValues(std::span<const AgentSetting> settings);

  double operator[](std::string_view name) const;  // throws std::out_of_range for a name that is not there
  int whole(std::string_view name) const { return static_cast<int>((*this)[name]); }
  double growth(std::string_view name) const;  // the value, in multiples of the default
  void set(std::size_t place, double value) { values_[place] = value; }  // as in settings()
  std::span<const AgentSetting> settings() const { return settings_; }
  bool operator==(const AgentValues& other) const { return values_ == other.values_; }

 private:
  std::size_t place_of(std::string_view name) const;

  std::span<const AgentSetting> settings_;
  std::vector<double> values_;
};

class GameFacts;

// The arguments from which an agent is made.
struct AgentContext {
  const AgentValues& values;
  int action = 0;  // of an agent that has one for each action
  std::uint64_t seed = 0;
  Cartridge cartridge;
  PlaySettings play;
  GameFacts* facts = nullptr;  // what was discovered about the game before

  std::vector<int> actions() const { return actions_of(play.action_set, *cartridge.game); }
};

// The role of an agent, which determines its trials unless the plan does.
enum class Role { kBaseline, kLearner, kPlanner };

// The time of a decision and the memory, in multiples of those with the default settings.
struct Effort {
  double time = 1, memory = 1;
};

struct AgentKind {
  std::string_view name;
  std::string_view summary;
  Role role;
  bool each_action = false;       // there is one of this kind for each of the 18 actions
  std::optional<int> frame_skip;  // frames of a decision; none: the plan's
  std::span<const AgentSetting> settings;
  // Decisions in a second of processor time, with the default settings: measured, the mean of the five
  // training games.
  double decisions_per_second;
  double megabytes;  // the most memory that a trial takes, a checkpoint being written included; measured
  // Estimates the effort with other settings. Null if they change it little.
  Effort (*effort)(const AgentValues& values) = nullptr;
  std::unique_ptr<Agent> (*make)(const AgentContext& context);
};

std::span<const AgentKind> agent_kinds();
const AgentKind* find_agent_kind(std::string_view name);  // null if the name is unknown

// Returns the name of an agent, such as "const_fire"; only the kind's name if the kind has one agent.
std::string agent_name(const AgentKind& kind, int action);

}  // namespace racebeam
