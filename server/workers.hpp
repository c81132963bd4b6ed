// Threads for what one session wants done in parallel: its many machines.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace racebeam {

class Workers {
 public:
  explicit Workers(unsigned threads);  // the caller of run() is one of them
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  // Runs task(0) ... task(count - 1) and returns when all are done. Every thread begins with a share of its
  // own, the same for the same count, so that what a task uses stays in one processor's cache; who is done
  // helps the others. From any thread, also from several at once. A task does not throw.
  void run(std::size_t count, const std::function<void(std::size_t)>& task);

 private:
  struct alignas(64) Share {
    std::atomic<std::size_t> next = 0;  // to be begun
    std::size_t end = 0;
  };
  struct Job {
    const std::function<void(std::size_t)>* task;
    std::span<Share> shares;  // one a thread; the caller's is the first
    std::size_t helpers = 0;  // threads that work on it beside the caller; under mutex_

    void work(std::size_t own);  // from that share on
    bool can_use_help() const;
  };

  void help(std::size_t own);
  Job* pick();  // under mutex_

  std::mutex mutex_;
  std::condition_variable job_is_here_, helper_left_;
  std::vector<Job*> jobs_;  // that can use help
  bool stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace racebeam
