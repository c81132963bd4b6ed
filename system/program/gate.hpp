// A gate at which threads wait until it opens. It stays open. It does not use wait() of std::atomic_flag:
// with g++ 12, a thread on Windows waits for ever if the flag changes just before the thread goes to sleep.
#pragma once

#include <condition_variable>
#include <mutex>

namespace racebeam {

class Gate {
 public:
  void open() {
    const std::lock_guard lock(mutex_);
    is_open_ = true;
    opened_.notify_all();
  }

  void wait() {
    std::unique_lock lock(mutex_);
    opened_.wait(lock, [this] { return is_open_; });
  }

  bool is_open() {
    const std::lock_guard lock(mutex_);
    return is_open_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable opened_;
  bool is_open_ = false;
};

}  // namespace racebeam
