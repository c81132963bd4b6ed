#include "protocol/classic/paced_classic.hpp"

#include "protocol/line/machine_memory.hpp"

namespace racebeam {

PacedClassic::PacedClassic(const ClassicService& service, const std::shared_ptr<MemoryBudget>& memory)
    : service_(service), memory_(memory ? memory : service.memory) {
  memory_.set(kMaxMachineMemory);
}

PacedClassic::~PacedClassic() { pacer_.cancel(); }

bool PacedClassic::work(std::chrono::microseconds slice) {
  if (is_ready_) return true;
  const auto begin = Pacer::Clock::now();
  is_ready_ = pacer_.work(begin + slice, [this] { answer(); });
  worked_ = Pacer::Clock::now() - begin;
  return is_ready_;
}

void PacedClassic::answer() {
  try {
    if (!machine_) machine_.emplace(service_.power_on(&pacer_));
    if (!session_) session_.emplace(*machine_, service_.options);
    reply_ = session_->reply();
    account();
  } catch (const std::exception&) {
    failure_ = std::current_exception();
  }
}

// If the saved states exceed the memory budget, the oldest one is dropped, because the protocol has no
// errors.
void PacedClassic::account() {
  caches_released_ = memory_.is_short();
  if (caches_released_) machine_->release_caches();
  const std::size_t bytes = footprint();
  if (bytes <= memory_.bytes()) {
    memory_.set(bytes);
  } else if (!memory_.grow(bytes - memory_.bytes())) {
    session_->forget_oldest_state();
  }
}

std::size_t PacedClassic::footprint() const {
  constexpr std::size_t kSession = std::size_t{64} << 10, kState = std::size_t{96} << 10;
  constexpr std::size_t kResting = std::size_t{100} << 10;
  const std::size_t ram = machine_->cartridge_ram_size();
  const std::size_t machine = caches_released_ ? kResting : kMaxMachineMemory;
  return kSession + machine + ram + session_->saved_states() * (kState + ram);
}

void PacedClassic::release_caches() {
  if (!machine_ || !session_) return;
  machine_->release_caches();
  caches_released_ = true;
  memory_.set(footprint());
}

std::optional<std::string_view> PacedClassic::reply() {
  check_machine();
  is_ready_ = false;
  return reply_;
}

void PacedClassic::check_machine() const {
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace racebeam
