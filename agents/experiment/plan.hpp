// The plan of an experiment: games, agents, trials, and every setting (docs/experiments.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "agents/features/background.hpp"
#include "agents/kinds/agent_table.hpp"
#include "games/images.hpp"

namespace racebeam {

// How long a trial is. Training ends after `training_episodes`, or, if that is not 0, after
// `training_frames`.
struct TrialLength {
  int trials = 1;
  int training_episodes = 0;
  int training_frames = 0;
  int evaluation_episodes = 1;
  bool operator==(const TrialLength&) const = default;
};

// An agent of the plan. If its kind has an agent for each action, it stands for all of them.
struct PlanAgent {
  const AgentKind* kind;
  AgentValues values;
  TrialLength length;
  int frame_skip;  // frames of a decision
};

struct PlanGame {
  std::string name;
  std::vector<int> actions = {};    // of the plan's action set
  std::string image_md5 = {};       // empty: not known yet
  std::string background_csv = {};  // the SHA-256 of the CSV file of its background; empty: it is discovered
};

struct Plan {
  std::string name;
  std::uint32_t seed = 1;
  std::string phrase = {};  // seeds of evaluation follow from it; empty: from `seed`
  int background_screens = 18000, class_screens = 36000;
  PlaySettings play;
  PlaySettings training;  // `play` with the settings that differ in training
  std::vector<PlanGame> games;
  std::vector<PlanAgent> agents;
  std::string version;            // of the program; empty: not known yet
  std::string environment_place;  // for errors: "FILE:LINE: environment: "; empty: the preset's settings
};

// A trial of one agent in one game: what is run, resumed and locked as a whole.
struct Unit {
  std::string name;  // GAME-AGENT-TRIAL
  const PlanGame* game;
  const PlanAgent* agent;
  std::string agent_name;
  int action = 0;  // of an agent that has one for each action
  int trial = 1;
};

constexpr std::size_t kMaxPlanBytes = std::size_t{1} << 20;  // of a plan's file

// Parses a plan. It may name games of the catalogue, and games with a rule among `images`. file: the name for
// errors. Throws InvalidInput: "FILE:LINE: FIELD: sentence".
Plan parse_plan(std::string_view text, const std::string& file, const Images& images = {});

// Returns the shipped plan with this name; otherwise reads the file.
Plan load_plan(const std::string& name_or_file, const Images& images = {});

// Sets the MD5s of the images and the version. Throws InvalidInput, which names all games without an image,
// a plan of other images or of another version, and a mode or difficulty that a game lacks.
void bind(Plan& plan, const Images& images, const std::string& version);
std::vector<std::string> games_without_image(const Plan& plan, const Images& images);

// The plan with every default written out. parse_plan() reads it back.
std::string text_of(const Plan& plan);

// Returns the actions for which there is an agent of this kind. If the kind has only one agent, it returns
// one action, which has no meaning.
std::vector<int> actions_of_agents(const PlanGame& game, const AgentKind& kind);
std::vector<Unit> units_of(const Plan& plan);  // in the plan's order: games, agents, trials

PlaySettings play_settings(const Plan& plan, const PlanAgent& agent);
// Returns the settings of training episodes. With life_loss=end, a lost life ends an episode for the agent,
// while the game continues (lives_end()).
PlaySettings training_settings(const Plan& plan, const PlanAgent& agent);
bool lives_end(const Plan& plan);  // whether a lost life ends an episode of training for the agent
SampleSettings sample_settings(const Plan& plan, const PlanGame& game);

// Derive seeds from the plan's seed and the unit's name, so that no unit depends on another.
std::uint32_t agent_seed(const Plan& plan, const Unit& unit);
std::uint32_t environment_seed(const Plan& plan, const Unit& unit, bool training, int episode);  // never 0

struct ShippedPlan {
  std::string_view name, summary, text;
};
std::span<const ShippedPlan> shipped_plans();

}  // namespace racebeam
