// Measures saving and restoring.
#pragma once

#include "cli/arguments/options.hpp"

namespace racebeam {

struct SnapshotTimes {
  std::size_t machine_bytes = 0;  // the machine's state
  double machine_ns = 0;          // to copy it out and back
  double hash_ns = 0;             // Environment::state_hash
  double compare_ns = 0;          // Environment::same_state, of two equal states
  double client_ns = 0;           // Environment::save and restore, with the pictures
  double round_ns = 0;            // save, one frame, restore: the frame allocates its own picture
  double frame_ns = 0;            // such a frame without a saved state
};

// Plays some frames first, so that the state is one from the middle of a game.
SnapshotTimes time_snapshots(const Cartridge& cartridge, const MachineOptions& options);

// Nanoseconds to copy the state of a machine in the middle of a game out and back: the mean of `times`.
double time_machine_snapshots(const Cartridge& cartridge, const MachineOptions& options, int times);

// Times Environment::save and restore in the same way.
double time_client_snapshots(Environment& environment, int times);

}  // namespace racebeam
