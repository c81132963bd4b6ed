#include "protocol/running/memory_budget.hpp"

#include "protocol/request_error.hpp"

namespace racebeam {

MemoryBudget::MemoryBudget(std::shared_ptr<MemoryBudget> whole)
    : whole_(std::move(whole)), most_(whole_->most_) {
  ++whole_->parts_;
}

MemoryBudget::~MemoryBudget() {
  if (whole_) --whole_->parts_;
}

std::shared_ptr<MemoryBudget> MemoryBudget::part(const std::shared_ptr<MemoryBudget>& whole,
                                                 const std::string& name) {
  const std::lock_guard lock(whole->mutex_);
  std::erase_if(whole->named_, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<MemoryBudget>& place = whole->named_[name];
  auto found = place.lock();
  if (!found) place = found = std::make_shared<MemoryBudget>(whole);
  return found;
}

bool MemoryBudget::take(std::uint64_t bytes, std::uint64_t spare) {
  if (whole_) {
    if (!whole_->take(bytes, spare)) return false;
    taken_ += bytes;
    return true;
  }
  const std::uint64_t most = most_ - spare;
  std::uint64_t before = taken_;
  do {
    if (before > most || bytes > most - before) return false;
  } while (!taken_.compare_exchange_weak(before, before + bytes));
  return true;
}

void MemoryBudget::take_anyway(std::uint64_t bytes) {
  if (whole_) whole_->take_anyway(bytes);
  taken_ += bytes;
}

void MemoryBudget::give_back(std::uint64_t bytes) {
  taken_ -= bytes;
  if (whole_) whole_->give_back(bytes);
}

std::uint64_t MemoryBudget::shortage() const {
  const std::uint64_t most = most_ - most_ / 16, taken = all().taken_;
  return taken > most ? taken - most : 0;
}

void MemoryShare::set(std::size_t bytes) {
  if (budget_ != nullptr && bytes > bytes_) budget_->take_anyway(bytes - bytes_);
  if (budget_ != nullptr && bytes < bytes_) budget_->give_back(bytes_ - bytes);
  bytes_ = bytes;
}

// How much must be left for others if the owner takes these bytes, too.
std::uint64_t MemoryShare::spare_after(std::size_t bytes) const {
  if (bytes_ + bytes > budget_->little()) return budget_->reserve();
  const MemoryBudget* const owner = budget_->whole();
  return owner != nullptr && owner->crowds_others_out() ? budget_->reserve_for_other_owners() : 0;
}

bool MemoryShare::grow(std::size_t bytes) {
  if (budget_ != nullptr && !budget_->take(bytes, spare_after(bytes))) return false;
  bytes_ += bytes;
  return true;
}

void MemoryShare::check(std::size_t bytes, const std::string& what) {
  if (grow(bytes)) return;
  throw RequestError(ErrorCode::kLimit, what + " would take about " + std::to_string(bytes >> 10) +
                                            " KiB of memory; the server's sessions hold " +
                                            std::to_string(budget_->all().taken() >> 20) +
                                            " MiB, and may hold " +
                                            std::to_string((budget_->most() - spare_after(bytes)) >> 20) +
                                            " MiB for one of this size");
}

}  // namespace racebeam
