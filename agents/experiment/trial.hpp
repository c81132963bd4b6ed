// Runs one unit of an experiment: a trial of an agent in a game. It continues from its checkpoint, if there
// is one.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "agents/experiment/plan.hpp"
#include "agents/experiment/play.hpp"
#include "agents/experiment/results.hpp"
#include "agents/kinds/agent_table.hpp"
#include "recording/sealed_file.hpp"

namespace racebeam {

inline constexpr SealedKind kCheckpoint = {
    .what = "checkpoint", .magic = "RBCHECKP", .version = 3, .most = std::size_t{8} << 30, .level = 1};

class Trial {
 public:
  // facts: of the unit's game; it outlives the trial. cpu changes only the speed.
  Trial(const Plan& plan, const Unit& unit, const ResultsFolder& folder, const Cartridge& cartridge,
        GameFacts* facts, CpuKind cpu);

  // Runs until the unit is finished and its files are written, or until stop(), which is asked before each
  // episode, returns true. Returns whether the unit is finished. A checkpoint is written at the end of an
  // episode when `every` has passed since the last one. on_decision(), unless empty, is called after each
  // decision.
  bool run(std::chrono::milliseconds every, const std::function<bool()>& stop,
           const std::function<void()>& on_decision = {});

  // For people: how far the trial is, and the mean of the evaluation so far.
  struct Place {
    int episodes = 0;            // that are over, of training and of evaluation
    std::int64_t decisions = 0;  // of the episode that is played
    double done = 0;  // of the trial's frames, from 0 to 1; an episode that is over counts as a full one
  };
  Place place() const;
  double mean_score() const;
  std::int64_t frames() const { return account_.frames; }

 private:
  // What a checkpoint contains besides the agent and the tables.
  struct Account {
    std::int32_t trained = 0, evaluated = 0;  // episodes
    std::int64_t training_frames = 0;
    std::int64_t frames = 0;  // of all episodes
    std::int64_t score = 0;   // the sum of evaluation episodes
    std::int64_t training_microseconds = 0, evaluation_microseconds = 0;
    std::int64_t searched_frames = 0;
  };

  bool training_is_over() const;
  bool is_over() const;
  void run_episode();
  Episode play_episode(Stage& stage, PlayOptions options);
  void train();
  void evaluate();
  void diverge();
  void keep_log(const Episode& episode, int number);
  void resume();
  void check_account() const;
  void check_tables() const;
  void write_checkpoint() const;
  void finish();

  const Plan& plan_;
  const Unit& unit_;
  const ResultsFolder& folder_;
  const TrialLength& length_;
  const AgentValues values_;
  std::unique_ptr<Agent> agent_;
  Stage stage_;
  std::optional<Stage> training_stage_;  // of a trial that trains
  Account account_;
  std::function<void()> on_decision_;
  std::int64_t decisions_ = 0, episode_frames_ = 0;  // of the episode that is played
  bool diverged_ = false;
  std::string rows_, curves_;  // lines of the tables
};

}  // namespace racebeam
