// Returns the memory of ended sessions to the system. Otherwise, the C library keeps free memory that lies
// between blocks in use. To release it takes about 0.3 ms a MiB, during which threads that allocate may have
// to wait. The keeper therefore waits until no session has ended for a while, and uses its own thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <thread>

namespace racebeam {

class HeapKeeper {
 public:
  using Clock = std::chrono::steady_clock;

  HeapKeeper() = default;
  ~HeapKeeper() { finish(); }
  HeapKeeper(const HeapKeeper&) = delete;
  HeapKeeper& operator=(const HeapKeeper&) = delete;

  // The caller calls it a few times a second. sessions: how many are open now.
  void update(std::int64_t sessions, Clock::time_point now = Clock::now());

  std::int64_t times() const { return times_; }  // how often it has returned memory

 private:
  void trim();
  void finish();

  std::int64_t most_ = 0, last_ = 0;  // sessions, since memory was returned
  Clock::time_point changed_{};
  std::int64_t times_ = 0;
  std::thread thread_;
};

}  // namespace racebeam
