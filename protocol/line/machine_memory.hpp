// What a machine holds in memory. It is told from what the machine has done, since the emulator does not
// count: it allocates pictures when it first draws on its own, and the records of lines when it draws after a
// rest.
#pragma once

#include <cstddef>

#include "environment/vector/slot.hpp"

namespace racebeam {

class MachineMemory {
 public:
  explicit MachineMemory(const Slot& slot) : begun_(frame_of(slot)), rested_(begun_) {}

  void rest(Slot& slot);                     // releases caches
  std::size_t held(const Slot& slot) const;  // bytes

  static constexpr std::size_t kMost = std::size_t{240} << 10;  // of a machine whose objects do not flicker

 private:
  static int frame_of(const Slot& slot) { return slot.environment().frame_number(); }

  int begun_, rested_;  // frames
};

}  // namespace racebeam
