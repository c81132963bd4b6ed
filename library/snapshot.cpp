#include "racebeam/snapshot.hpp"

#include "environment/saved/saved_state_format.hpp"
#include "environment/vector/saved_slot_format.hpp"
#include "library/internals.hpp"

namespace racebeam::v0 {

Snapshot::Snapshot(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Snapshot Snapshot::from_bytes(std::span<const std::uint8_t> bytes) {
  auto impl = std::make_shared<Impl>();
  impl->bytes.assign(bytes.begin(), bytes.end());
  return Snapshot(std::move(impl));
}

// The pictures may have been left to be drawn. A machine of the snapshot's own draws them, since the one that
// saved it may be running.
std::vector<std::uint8_t> Snapshot::to_bytes() const {
  if (!impl_->saved.machine) return impl_->bytes;
  const racebeam::Environment artist(impl_->cartridge.image, impl_->cartridge.game, impl_->settings);
  if (impl_->is_of_slot) return racebeam::to_bytes(impl_->saved, artist);
  return racebeam::to_bytes(*impl_->saved.machine, artist);
}

Slot::Saved Internals::saved(const Snapshot& snapshot, const racebeam::Environment& environment) {
  const Snapshot::Impl& impl = *snapshot.impl_;
  if (impl.saved.machine) return impl.saved;
  if (is_saved_slot(impl.bytes)) return saved_slot(impl.bytes, environment);
  Slot::Saved saved;
  saved.machine = racebeam::from_bytes(impl.bytes, environment);
  return saved;
}

}  // namespace racebeam::v0
