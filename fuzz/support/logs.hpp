// Logs of episodes, for targets that seal their contents and play them again.
#pragma once

#include <algorithm>
#include <cstdint>

#include "agents/experiment/play.hpp"
#include "fuzz/support/keep_code.hpp"
#include "games/images.hpp"
#include "recording/sealed_file.hpp"

namespace racebeam::fuzz {

// As in recording/episode_log.cpp, which refuses other kinds. It compresses less, and takes less time.
inline constexpr SealedKind kEpisodeLog = {
    .what = "episode log", .magic = "RBEPISOD", .version = 1, .most = std::size_t{2} << 20, .level = 1};

// Our own games, whose logs are played.
inline const Images& own_images() {
  static const Images images = [] {
    Images all;
    for (const char* name : {"beamfall", "updraft"}) keep_code(*all.find(name));
    return all;
  }();
  return images;
}

// Whether to play the log takes too long for one input. Throws InvalidInput for unknown settings.
inline bool takes_long(const EpisodeLog& log) {
  constexpr std::int64_t kMaxFrames = 20000;
  const PlaySettings settings = settings_of(log);
  const int skip = std::max(settings.machine.frame_skip, settings.machine.frame_skip_max);
  return skip * (static_cast<std::int64_t>(log.actions.size()) + settings.noop_max) > kMaxFrames;
}

}  // namespace racebeam::fuzz
