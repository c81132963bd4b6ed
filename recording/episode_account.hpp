// Collects the results of an episode while it is played, for its log.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "environment/vector/slot.hpp"
#include "recording/episode_log.hpp"

namespace racebeam {

class EpisodeAccount {
 public:
  // The caller calls it after each decision, with the number of frames that it took.
  void add(const Environment& machine, int frames) {
    end_.score += machine.raw_rewards().a;
    end_.frames += frames;
    if (++end_.decisions % kDecisionsPerStretch == 0) hashes_.push_back(machine.state_hash());
  }

  std::int64_t decisions() const { return end_.decisions; }
  std::int64_t frames() const { return end_.frames; }

  EpisodeEnd finish(const Environment& machine, LifeLoss life_loss) {
    if (hashes_.size() < hashes_of(static_cast<std::size_t>(end_.decisions)))
      hashes_.push_back(machine.state_hash());
    const bool terminated = ends_of(machine, life_loss).terminated;
    end_.over = terminated ? EpisodeOver::kTerminated : EpisodeOver::kTruncated;
    end_.lives = machine.lives();
    return end_;
  }
  std::vector<std::uint64_t> take_hashes() { return std::move(hashes_); }  // after finish()

 private:
  EpisodeEnd end_;
  std::vector<std::uint64_t> hashes_;
};

}  // namespace racebeam
