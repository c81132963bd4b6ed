// A slot's saved state as bytes that another process can restore: the progress of its episode, its stack of
// screens, the generator of no-ops, and the machine's state (environment/saved/saved_state_format.hpp).
// docs/states.md has the layout. A change to it must increment kSavedSlotVersion.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "environment/vector/slot.hpp"

namespace racebeam {

constexpr std::uint32_t kSavedSlotVersion = 1;

// `environment` is of the same image and game, and draws the pictures if they are deferred; it is not
// changed. Throws InvalidInput if it could not restore the state.
std::vector<std::uint8_t> to_bytes(const Slot::Saved& saved, const Environment& environment);

bool is_saved_slot(std::span<const std::uint8_t> bytes);  // whether they begin as a slot's do

// Throws InvalidInput if `bytes` are not of a slot, were truncated or altered, or come from another version
// of racebeam.
void check_saved_slot(std::span<const std::uint8_t> bytes);

// Throws the same, and InvalidInput if the machine's state is not one that `environment` can restore, or a
// value is impossible. A returned state can be restored and run, whatever its source.
Slot::Saved saved_slot(std::span<const std::uint8_t> bytes, const Environment& environment);

}  // namespace racebeam
