// The machine of `load`: a slot, and the fields that its client observes.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "environment/settings/play_settings.hpp"
#include "environment/vector/slot.hpp"
#include "games/catalogue.hpp"
#include "protocol/line/action.hpp"
#include "protocol/line/field.hpp"
#include "protocol/line/machine_memory.hpp"
#include "protocol/running/pacer.hpp"

namespace racebeam {

class LoadedMachine {
 public:
  // Powers on, sets mode and difficulty, and begins an episode. Throws InvalidInput, and what `pacer` throws.
  // `pacer` must outlive this object.
  LoadedMachine(const Cartridge& cartridge, const PlaySettings& settings, std::vector<Field> fields,
                Pacer& pacer);

  Pacer& pacer() { return pacer_; }
  Slot& slot() { return slot_; }
  Environment& machine() { return slot_.environment(); }
  const Environment& machine() const { return slot_.environment(); }
  AllowedActions allowed() const { return {machine().game().name, allowed_, allowed_b_}; }

  // Bytes of memory that a machine with these fields may come to hold, without RAM on the cartridge.
  static std::size_t max_footprint(const std::vector<Field>& fields);
  // Bytes that this machine holds. Its view counts with at least `least_of_view` of them.
  std::size_t footprint(std::size_t least_of_view = 0) const {
    return machine_memory(slot_) + std::max(view_.footprint(), least_of_view);
  }
  void release_caches();

  void observe(std::vector<Field> fields);
  void append_view(std::string& out, std::string& raw) { view_.append(out, raw, slot_); }
  void append_final(std::string& out, std::string& raw) { view_.append_final(out, raw, slot_); }

 private:
  void allow_actions();

  Pacer& pacer_;
  Slot slot_;
  std::bitset<kActionNumbers> allowed_, allowed_b_;  // bit n: action n
  View view_;
};

// The settings of a slot for these settings of `load`. Its steps are acts.
SlotSettings slot_settings(const PlaySettings& settings);

// Makes the slot draw and stack the screens that the fields show.
void observe(Slot& slot, const std::vector<Field>& fields);

}  // namespace racebeam
