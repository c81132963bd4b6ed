// The log of one episode: what is needed to replay it, and its results (docs/episodes.md).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "environment/settings/play_settings.hpp"

namespace racebeam {

constexpr int kMaxDecisions = 2'000'000;   // of an episode, so that its log has at most two MiB
constexpr int kMaxTurns = 400'000;         // if the log has strengths
constexpr int kDecisionsPerStretch = 256;  // a log has the state's hash after each stretch

enum class EpisodeOver { kTerminated, kTruncated };
std::string_view name_of(EpisodeOver over);

// The results of an episode.
struct EpisodeEnd {
  std::int64_t score = 0;  // the sum of raw rewards
  std::int64_t frames = 0, decisions = 0;
  EpisodeOver over = EpisodeOver::kTruncated;
  int lives = 0;
  bool operator==(const EpisodeEnd&) const = default;
};

// The agent that played, and the settings.
struct EpisodeOrigin {
  std::string unit, agent;
  int trial = 1, episode = 1;
  std::uint32_t agent_seed = 0;
  std::string version;  // of the program
};

struct EpisodeLog {
  std::string game, image_md5;
  std::string settings;  // words of `load`, including the seed
  EpisodeOrigin origin;
  EpisodeEnd end;
  std::vector<std::uint64_t> hashes;  // of the state after each stretch, and at the end
  std::vector<std::uint8_t> actions;
  std::vector<float> strengths;  // of the paddle, for each action; empty if all are 1

  float strength(std::size_t decision) const { return strengths.empty() ? 1 : strengths[decision]; }
};

// The number of hashes in the log of an episode with this many decisions.
std::size_t hashes_of(std::size_t decisions);

// Returns the bytes of the log's file. `pause` is passed on to seal() (recording/sealed_file.hpp).
std::string bytes_of(const EpisodeLog& log, const std::function<void()>& pause = {});
// Reads a log from the bytes of its file. `name` is for errors. Throws InvalidInput for bytes that are not a
// log.
EpisodeLog log_of(const std::string& name, std::string_view bytes);

// The size of the largest log file, in bytes. A larger file is refused without being read.
extern const std::size_t kMaxLogBytes;

// The words of `load` that restart this episode, which `machine` plays.
std::string words_of(const PlaySettings& settings, const Environment& machine);

// The settings of a log in the order of their names, without the seed. All logs of a submission have the
// same.
std::string settings_without_seed(const std::string& settings);

}  // namespace racebeam
