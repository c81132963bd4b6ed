// A saved state of a game: after a restore, picture, RAM, rewards and later frames are the same. A Snapshot
// never changes and its copies share their data, so any number of threads may use one.
//
//     racebeam::Environment environment(racebeam::Image::load("builtin:beamfall"));
//     const racebeam::Snapshot before = environment.save();
//     const int reward = environment.step(racebeam::Action::kFire);
//     environment.restore(before);  // tries another action from here
//
//     const std::vector<std::uint8_t> bytes = before.to_bytes();  // for a file or another process
//     environment.restore(racebeam::Snapshot::from_bytes(bytes));
//     std::cout << "the reward was " << reward << '\n';
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "racebeam/config.hpp"

namespace RACEBEAM_NAMESPACE {

class RACEBEAM_API Snapshot {
 public:
  // Returns the portable form, which environments of this version restore on any computer (docs/states.md).
  // Takes some milliseconds, and about 70 KB. The snapshot itself takes 4 KB, and shares its pictures.
  std::vector<std::uint8_t> to_bytes() const;

  // Returns a snapshot of a copy of `bytes`, whatever they are. Environment::restore() checks them: it throws
  // Error if they were truncated or altered, are of another version, or have a value that no machine can
  // have.
  static Snapshot from_bytes(std::span<const std::uint8_t> bytes);

 private:
  friend struct Internals;
  struct Impl;
  explicit Snapshot(std::shared_ptr<const Impl> impl);

  std::shared_ptr<const Impl> impl_;
};

}  // namespace RACEBEAM_NAMESPACE
