// Lets the caller of a long request interrupt it, for example by Ctrl-C in Python: the caller's thread checks
// for that between two machines.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <thread>

namespace racebeam {

// Called on the thread of a request's caller, about every 50 ms. What it throws ends the request.
using InterruptCheck = void (*)();

// Polls for the interruption of one request.
class InterruptPoll {
 public:
  static constexpr std::chrono::milliseconds kInterval{50};

  // interrupt_check: null if the request cannot be interrupted.
  explicit InterruptPoll(InterruptCheck interrupt_check)
      : interrupt_check_(interrupt_check), caller_(std::this_thread::get_id()), next_(after_interval()) {}

  // Calls the check if kInterval has passed since the last call. Throws what the check throws.
  void poll() {
    if (interrupt_check_ == nullptr || Clock::now() < next_) return;
    interrupt_check_();
    next_ = after_interval();
  }

  // Polls on behalf of a task that runs on any thread and must not throw. Returns false if the request was
  // interrupted: the task then does nothing.
  bool may_continue() {
    if (std::this_thread::get_id() == caller_ && !ended_) {
      try {
        poll();
      } catch (...) {
        failure_ = std::current_exception();
        ended_ = true;
      }
    }
    return !ended_.load(std::memory_order_relaxed);
  }

  // Called after the tasks. Throws what interrupted the request.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  static Clock::time_point after_interval() { return Clock::now() + kInterval; }

  const InterruptCheck interrupt_check_;
  const std::thread::id caller_;
  Clock::time_point next_;
  std::exception_ptr failure_;  // only the caller's thread uses it
  std::atomic<bool> ended_ = false;
};

}  // namespace racebeam
