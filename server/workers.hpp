// Threads for what one session wants done in parallel: its many machines.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace racebeam {

class Workers {
 public:
  explicit Workers(unsigned threads);  // the caller of run() is one of them
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  // Runs task(0) ... task(count - 1) and returns when all are done. From any thread, also from several at
  // once. A task does not throw.
  void run(std::size_t count, const std::function<void(std::size_t)>& task);

 private:
  struct Job {
    const std::function<void(std::size_t)>* task;
    std::size_t count;
    std::atomic<std::size_t> next = 0;  // to be begun
    std::size_t helpers = 0;            // threads that work on it beside the caller; under mutex_
  };

  static void work(Job& job);
  void help();
  Job* pick();  // under mutex_

  std::mutex mutex_;
  std::condition_variable job_is_here_, helper_left_;
  std::vector<Job*> jobs_;  // that can use help
  bool stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace racebeam
