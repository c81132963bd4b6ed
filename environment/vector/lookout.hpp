// A request may take long, and its caller may want to end it. The caller's thread therefore checks for that
// between two machines.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <thread>

namespace racebeam {

// Called on the thread of a request's caller, from its first 50 ms on and about as often. What it throws ends
// the request.
using Watch = void (*)();

// Checks for the end of one request. `watch` may be null.
class Lookout {
 public:
  static constexpr std::chrono::milliseconds kInterval{50};

  explicit Lookout(Watch watch)
      : watch_(watch), caller_(std::this_thread::get_id()), next_(after_interval()) {}

  // Calls `watch` if it is time. Throws what it throws.
  void look() {
    if (watch_ == nullptr || Clock::now() < next_) return;
    watch_();
    next_ = after_interval();
  }

  // Checks on behalf of a task that runs on any thread and must not throw. False: the request has ended, and
  // the task does nothing.
  bool may_continue() {
    if (std::this_thread::get_id() == caller_ && !ended_) {
      try {
        look();
      } catch (...) {
        failure_ = std::current_exception();
        ended_ = true;
      }
    }
    return !ended_.load(std::memory_order_relaxed);
  }

  // After the tasks: throws what ended the request.
  void check() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  static Clock::time_point after_interval() { return Clock::now() + kInterval; }

  const Watch watch_;
  const std::thread::id caller_;
  Clock::time_point next_;
  std::exception_ptr failure_;  // only the caller's thread uses it
  std::atomic<bool> ended_ = false;
};

}  // namespace racebeam
