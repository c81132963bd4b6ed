// Plays episodes of an agent, and repeats those of logs.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "agents/base/agent.hpp"
#include "environment/settings/play_settings.hpp"
#include "games/catalogue.hpp"
#include "recording/episode_log.hpp"

namespace racebeam {

// Throws InvalidInput for settings that a log could not repeat.
void check_episode_settings(const PlaySettings& settings);

// A machine on which one episode after the other is played, each as `load` begins it.
class Stage {
 public:
  // `settings` are without a seed. Throws InvalidInput for settings that the game cannot have.
  Stage(const Cartridge& cartridge, const PlaySettings& settings, Drawing drawing);

  void begin(std::uint32_t seed);  // powers the machine on anew

  Environment& machine() { return machine_; }
  const PlaySettings& settings() const { return settings_; }  // with the episode's seed

 private:
  PlaySettings settings_;
  Environment machine_;
};

struct Episode {
  EpisodeEnd end;
  std::vector<std::uint64_t> hashes;
  std::vector<std::uint8_t> actions;
  bool diverged = false;  // the agent's values diverged, which ended the episode early
};

// Called after each decision, with the decisions and frames of the episode so far.
using DecisionCallback = std::function<void(std::int64_t decisions, std::int64_t frames)>;

struct PlayOptions {
  std::int64_t most_frames = std::numeric_limits<std::int64_t>::max();
  bool lives_end = false;             // a lost life ends an episode for the agent, and the game goes on
  DecisionCallback on_decision = {};  // may be empty
};

// Plays the episode that stage.begin() has begun, until its end or until options.most_frames.
Episode play(Agent& agent, Stage& stage, const PlayOptions& options = {});

// The result of playing the actions of a log.
struct Replay {
  EpisodeEnd end;
  std::vector<std::uint64_t> hashes;
  bool over = false;  // the last action ended the episode; no actions are played after its end
};

// Plays logs, each on a new machine, from several threads at once. The last machines are kept, since a new
// one uses the translated code of another with the same image.
class Replayer {
 public:
  // Keeps as many machines as there are threads.
  Replayer(unsigned threads, CpuKind cpu) : most_kept_(threads), cpu_(cpu) {}

  // Throws InvalidInput for settings that the game cannot have.
  Replay play(const EpisodeLog& log, const Cartridge& cartridge);

 private:
  void keep(std::unique_ptr<Stage> stage);

  const std::size_t most_kept_;
  const CpuKind cpu_;
  std::mutex mutex_;
  std::deque<std::unique_ptr<Stage>> kept_;  // the oldest first
};

// Returns the settings of a log. Throws InvalidInput if they are invalid.
PlaySettings settings_of(const EpisodeLog& log);

}  // namespace racebeam
