// Settings and moves that tests of slots share.
#pragma once

#include "environment/vector/slot.hpp"
#include "tests/environment/steered.hpp"

namespace racebeam::test {

inline Cartridge cartridge() { return {counter_image(), game()}; }

inline SlotSettings no_noops() {
  SlotSettings settings;
  settings.machine.random_seed = 4;
  settings.machine.frame_skip = 3;
  settings.noop_max = 0;
  return settings;
}

inline void lose_life(Slot& slot, int remaining) {
  slot.environment().set_ram(kLives, 3);
  slot.act({});
  slot.environment().set_ram(kLives, static_cast<std::uint8_t>(remaining));
  slot.begin_request();
  slot.act({});
}

}  // namespace racebeam::test
