#include "server/operation/heap_keeper.hpp"

#include <algorithm>
#include <system_error>

#include "system/resources.hpp"

namespace racebeam {
namespace {

constexpr std::chrono::seconds kQuiet{1};
constexpr std::int64_t kWorthwhile = 16;  // sessions; fewer leave little memory behind

}  // namespace

void HeapKeeper::update(std::int64_t sessions, Clock::time_point now) {
  most_ = std::max(most_, sessions);
  if (sessions != last_) changed_ = now;
  last_ = sessions;
  if (most_ - sessions < kWorthwhile || now - changed_ < kQuiet) return;
  most_ = sessions;
  trim();
}

void HeapKeeper::trim() {
  finish();
  try {
    thread_ = std::thread(trim_heap);
    ++times_;
  } catch (const std::system_error&) {
    // The system has no thread to spare now. After later sessions, there is another attempt.
  }
}

void HeapKeeper::finish() {
  if (thread_.joinable()) thread_.join();
}

}  // namespace racebeam
