#include "clients/python/core/ale_state.hpp"

#include <cstring>
#include <span>

#include "environment/saved/saved_state_format.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::python {
namespace {

constexpr std::string_view kMagic = "RBALE001";

// The bytes are the magic, the facts as four integers of 32 bits, and the state in the form of the line
// protocol.
static_assert(sizeof(AleState::Facts) == 16);
constexpr std::size_t kHead = kMagic.size() + sizeof(AleState::Facts);

std::span<const std::uint8_t> state_in(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()) + kHead, bytes.size() - kHead};
}

}  // namespace

AleState::AleState(std::shared_ptr<Machine> machine, bool with_random) : machine_(std::move(machine)) {
  const Environment& environment = machine_->environment;
  saved_ = environment.save(with_random);
  facts_ = {environment.frame_number(), environment.episode_frame_number(), environment.difficulty(),
            environment.mode()};
}

AleState::AleState(std::string bytes) : bytes_(std::move(bytes)) {
  if (bytes_.empty()) return;
  if (bytes_.size() < kHead || !bytes_.starts_with(kMagic))
    throw InvalidInput(
        "these " + std::to_string(bytes_.size()) +
        " bytes are not a state; ALEState takes what racebeam's ALEState.serialize() returned");
  std::memcpy(&facts_, bytes_.data() + kMagic.size(), sizeof facts_);
}

void AleState::restore_in(Environment& environment) const {
  if (saved_) return environment.restore(*saved_);
  if (bytes_.empty()) throw InvalidInput("the state is of no game: it was made by ALEState() without bytes");
  environment.restore(*from_bytes(state_in(bytes_), environment));
}

std::string AleState::serialize() const {
  if (!saved_) return bytes_;
  const Turn turn(*machine_->lock);
  const std::vector<std::uint8_t> state = to_bytes(*saved_, machine_->environment);
  std::string bytes(kMagic);
  bytes.append(reinterpret_cast<const char*>(&facts_), sizeof facts_);
  bytes.append(reinterpret_cast<const char*>(state.data()), state.size());
  return bytes;
}

bool AleState::equals(const AleState& other) const { return serialize() == other.serialize(); }

}  // namespace racebeam::python
