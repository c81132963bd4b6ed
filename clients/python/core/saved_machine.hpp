// A state of one machine of many, in memory or as bytes.
#pragma once

#include <string>

#include "environment/vector/slot.hpp"
#include "games/catalogue.hpp"

namespace racebeam::python {

class SavedMachine {
 public:
  // Saves the slot's present state. cartridge: what the slot plays. with_random: whether to include its
  // random generators.
  SavedMachine(const Slot& slot, Cartridge cartridge, bool with_random);

  // Takes bytes of serialize(). Throws InvalidInput for bytes that were cut or altered, or are of another
  // version; the rest is checked when the state is restored.
  explicit SavedMachine(std::string bytes);

  // Throws InvalidInput if the state has another image, game or stack than the slot, or an impossible value;
  // the slot is then unchanged.
  void restore_in(Slot& slot) const;

  // Does not use anything that another thread changes.
  std::string serialize() const;

 private:
  Cartridge cartridge_;  // without an image, the state came as bytes
  Settings settings_;
  Slot::Saved saved_;
  std::string bytes_;
};

}  // namespace racebeam::python
