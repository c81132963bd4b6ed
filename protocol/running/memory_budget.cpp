#include "protocol/running/memory_budget.hpp"

#include "protocol/request_error.hpp"

namespace racebeam {

bool MemoryBudget::take(std::uint64_t bytes) {
  std::uint64_t taken = taken_;
  do {
    if (taken > most_ || bytes > most_ - taken) return false;
  } while (!taken_.compare_exchange_weak(taken, taken + bytes));
  return true;
}

void MemoryBudget::take_anyway(std::uint64_t bytes) { taken_ += bytes; }

void MemoryShare::set(std::size_t bytes) {
  if (budget_ != nullptr && bytes > bytes_) budget_->take_anyway(bytes - bytes_);
  if (budget_ != nullptr && bytes < bytes_) budget_->give_back(bytes_ - bytes);
  bytes_ = bytes;
}

bool MemoryShare::grow(std::size_t bytes) {
  if (budget_ != nullptr && !budget_->take(bytes)) return false;
  bytes_ += bytes;
  return true;
}

void MemoryShare::check(std::size_t bytes, const std::string& what) {
  if (grow(bytes)) return;
  throw RequestError(ErrorCode::kLimit, what + " would take about " + std::to_string(bytes >> 10) +
                                            " KiB of memory; the server's sessions hold " +
                                            std::to_string(budget_->taken() >> 20) + " MiB and may hold " +
                                            std::to_string(budget_->most() >> 20) + " MiB");
}

}  // namespace racebeam
