#include "protocol/line/loaded_machine.hpp"

#include <algorithm>

#include "environment/input/has_paddles.hpp"

namespace racebeam {

SlotSettings slot_settings(const PlaySettings& settings) {
  SlotSettings slot;
  slot.machine = settings.machine;
  slot.machine.truncate_on_life_loss = truncates_on_life_loss(settings);
  slot.life_loss = settings.life_loss;
  slot.mode = settings.mode;
  slot.difficulty = settings.difficulty;
  slot.action_set = settings.action_set;
  slot.steps = Steps::kActs;
  slot.noop_max = settings.noop_max;
  slot.fire_at_reset = false;
  return slot;
}

void observe(Slot& slot, const std::vector<Field>& fields) {
  const auto stacked =
      std::ranges::find_if(fields, [](const Field& field) { return field.stack.has_value(); });
  slot.set_drawing(drawing_of(fields, slot.environment().settings().color_averaging));
  slot.environment().make_all_audio(shows_all_audio(fields));
  slot.set_stack(stacked == fields.end() ? std::nullopt : stacked->stack);
}

LoadedMachine::LoadedMachine(const Cartridge& cartridge, const PlaySettings& settings,
                             std::vector<Field> fields, Pacer& pacer)
    : pacer_(pacer), slot_(cartridge, slot_settings(settings), &pacer), view_({}) {
  allow_actions();
  observe(std::move(fields));
}

// Player B has those of player A's that are a joystick's and, with the console's, those of the controller at
// the right.
void LoadedMachine::allow_actions() {
  const auto index = [](int action) { return static_cast<std::size_t>(action); };
  for (const int action : slot_.actions()) {
    allowed_.set(index(action));
    if (action < kActions) allowed_b_.set(index(action));
  }
  if (!allowed_[index(kResetAction)]) return;
  for (const int action : actions_with(properties_of(slot_.environment()).right))
    allowed_b_.set(index(action));
}

std::size_t LoadedMachine::max_footprint(const std::vector<Field>& fields) {
  return kMaxMachineMemory + View::max_footprint(fields);
}

void LoadedMachine::release_caches() {
  slot_.environment().release_caches();
  view_.release_caches();
}

void LoadedMachine::observe(std::vector<Field> fields) {
  racebeam::observe(slot_, fields);
  view_ = View(std::move(fields), [&pacer = pacer_] { pacer.yield_if_due(); });
}

}  // namespace racebeam
