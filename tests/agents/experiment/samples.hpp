// Episodes, plans and folders for the tests of experiments, all on our own games.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "agents/experiment/experiment.hpp"
#include "agents/experiment/plan.hpp"
#include "agents/experiment/play.hpp"
#include "agents/kinds/baselines.hpp"
#include "tests/games/scratch.hpp"

namespace racebeam::test {

inline std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// The rows of a table of results, which is in order.
inline std::vector<ResultRow> rows_of(const std::string& table) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);  // the columns
  std::vector<ResultRow> rows;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    for (std::string& value : rows.emplace_back()) std::getline(fields, value, ',');
  }
  return rows;
}

inline Cartridge beamfall() { return {load_image("builtin:beamfall"), find_game("beamfall")}; }

inline PlaySettings short_episodes(int frames = 3000) {
  PlaySettings play;
  play.machine.frame_skip = 5;
  play.machine.sticky = 0;
  play.machine.max_episode_frames = frames;
  return play;
}

inline EpisodeLog log_of_episode(Agent& agent, const PlaySettings& play, std::uint32_t seed,
                                 const Cartridge& cartridge = beamfall()) {
  Stage stage(cartridge, play, Drawing::kNone);
  stage.begin(seed);
  const Episode episode = racebeam::play(agent, stage);
  EpisodeLog log;
  log.game = cartridge.game->name;
  log.image_md5 = cartridge.image->md5;
  log.settings = words_of(stage.settings(), stage.machine());
  log.origin = {"beamfall-random-1", "random", 1, 1, seed, "0.1.0"};
  log.end = episode.end;
  log.hashes = episode.hashes;
  log.actions = episode.actions;
  return log;
}

// A log of random play.
inline EpisodeLog random_log(const PlaySettings& play, std::uint32_t seed = 7) {
  FixedPolicy agent(0, 0, seed);
  return log_of_episode(agent, play, seed);
}

inline Plan bound_plan(const std::string& text) {
  Plan plan = parse_plan(text, "test.toml");
  bind(plan, Images(), "0.1.0");
  return plan;
}

inline void run(const Plan& plan, const ResultsFolder& folder, ExperimentSettings settings = {}) {
  run_experiment(plan, Images(), folder, settings, [](const Progress&) {});
}

}  // namespace racebeam::test
