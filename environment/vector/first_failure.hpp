// The failure of tasks that run on several threads. Only one is kept: when memory runs out, thousands of
// exceptions at once would exhaust the reserve from which the library allocates them.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <mutex>

namespace racebeam {

class FirstFailure {
 public:
  // Whether a task with a lower number has failed, so that this one need not run.
  bool is_before(std::size_t number) const { return first_.load(std::memory_order_relaxed) < number; }

  // Keeps the exception that is being handled, unless a task with a lower number has failed.
  void keep(std::size_t number) {
    const std::lock_guard lock(mutex_);
    if (first_ < number) return;
    failure_ = std::current_exception();
    first_ = number;
  }

  // Called after the tasks. Throws the exception that was kept, if there is one.
  void check() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::mutex mutex_;
  std::atomic<std::size_t> first_ = std::numeric_limits<std::size_t>::max();
  std::exception_ptr failure_;  // under the mutex
};

}  // namespace racebeam
