// The memory that a machine holds. The emulator does not count it, so it is estimated from the machine's past
// operations. A machine that plays has two pictures, or one if its screens are not observed. Until it plays,
// it has one spare picture. It holds the spare picture and the records of lines until it rests; the next
// frame creates them again.
#pragma once

#include <cstddef>
#include <optional>

#include "environment/vector/slot.hpp"

namespace racebeam {

class MachineMemory {
 public:
  explicit MachineMemory(const Slot& slot) : first_frame_(frame_of(slot)) {}

  void release_caches(Slot& slot);
  std::size_t held(const Slot& slot) const;  // bytes

  static constexpr std::size_t kMax = std::size_t{240} << 10;  // of a machine whose objects do not flicker

 private:
  static int frame_of(const Slot& slot) { return slot.environment().frame_number(); }

  int first_frame_;            // the frame when the machine was made
  std::optional<int> rested_;  // that of the last rest
};

}  // namespace racebeam
