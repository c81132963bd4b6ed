// One machine of a Batch: the frame loop of the reference's vector environment (docs/spec/environment.md,
// 15).
#pragma once

#include "environment/input/noops.hpp"
#include "environment/observe/preprocess.hpp"
#include "environment/vector/batch.hpp"

namespace racebeam {

class Lane {
 public:
  // `number`: its place in the arrays of `results`.
  Lane(const Cartridge& cartridge, const BatchSettings& settings, std::size_t number);

  const Environment& environment() const { return environment_; }
  const std::vector<int>& actions() const { return *actions_; }

  // Each writes this machine's part of `results`.
  void reset(BatchResults& results);
  void step(int action, BatchResults& results);

 private:
  void begin_episode(BatchResults& results);
  void play(int action, BatchResults& results);
  int looked_at() const;
  bool pools() const;
  void look(int left);
  void push(BatchResults& results);
  void tell(BatchResults& results) const;
  std::span<std::uint8_t> stack(std::vector<std::uint8_t>& of) const;

  const BatchSettings& settings_;
  std::size_t number_;
  Environment environment_;
  const std::vector<int>* actions_;
  Noops noops_;
  const AreaResize& resize_;
  const GreyTable& grey_;
  std::vector<std::uint8_t> pooled_;  // grey: what the newest small screen was made from
  int elapsed_ = 0;                   // frames of play in this episode
  int lives_ = 0;                     // after the last step
  bool finished_ = false;             // the episode
};

}  // namespace racebeam
