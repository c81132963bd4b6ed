#include "clients/python/core/saved_machine.hpp"

#include <span>

#include "environment/vector/saved_slot_format.hpp"

namespace racebeam::python {
namespace {

std::span<const std::uint8_t> as_span(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

void restore_checked(Slot& slot, const Slot::Saved& saved) {
  slot.check_stack(saved);
  slot.restore(saved);
}

}  // namespace

SavedMachine::SavedMachine(const Slot& slot, Cartridge cartridge, bool with_random)
    : cartridge_(std::move(cartridge)),
      settings_(slot.environment().settings()),
      saved_(slot.save(with_random, with_random)) {}

SavedMachine::SavedMachine(std::string bytes) : bytes_(std::move(bytes)) {
  check_saved_slot(as_span(bytes_));
}

void SavedMachine::restore_in(Slot& slot) const {
  if (cartridge_.image) return restore_checked(slot, saved_);
  restore_checked(slot, saved_slot(as_span(bytes_), slot.environment()));
}

// Some pictures of the state may not have been drawn yet. A separate machine draws them, since the state's
// own machine may be playing.
std::string SavedMachine::serialize() const {
  if (!cartridge_.image) return bytes_;
  const Environment artist(cartridge_.image, cartridge_.game, settings_);
  const std::vector<std::uint8_t> bytes = to_bytes(saved_, artist);
  return {bytes.begin(), bytes.end()};
}

}  // namespace racebeam::python
