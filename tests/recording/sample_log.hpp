// A log of an episode that nobody has played.
#pragma once

#include <random>
#include <string>

#include "recording/episode_log.hpp"

namespace racebeam::test {

inline EpisodeLog sample_log(int decisions = 300) {
  EpisodeLog log;
  log.game = "beamfall";
  log.image_md5 = std::string(32, 'a');
  log.settings = "seed=7 frame_skip=4 sticky=0.25";
  log.origin = {"beamfall-agent-2", "agent", 2, 3, 4294967295U, "1.2.3"};
  log.end = {-50, std::int64_t{4} * decisions, decisions, EpisodeOver::kTerminated, 5};
  std::mt19937_64 random(1);
  while (log.hashes.size() < hashes_of(static_cast<std::size_t>(decisions))) log.hashes.push_back(random());
  while (log.actions.size() < static_cast<std::size_t>(decisions))
    log.actions.push_back(static_cast<std::uint8_t>(random() % 18));
  return log;
}

}  // namespace racebeam::test
