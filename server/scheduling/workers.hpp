// Threads for what one session wants done in parallel: its many machines. Between jobs that follow each other
// closely they wait awake, as long as BusyPoll says.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "server/scheduling/busy_poll.hpp"

namespace racebeam {

class Workers {
 public:
  // The caller of run() is one of the threads. `busy_poll`: how long to wait awake at most; 0: never.
  Workers(unsigned threads, std::chrono::microseconds busy_poll);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  // Runs task(0) ... task(count - 1) and returns when all are done. Every thread begins with a share of its
  // own, the same for the same count, so that what a task uses stays in one processor's cache; who is done
  // helps the others. From any thread, also from several at once. A task does not throw. Callers count among
  // the threads that work: more of them than there are would wait for helpers that wait for a processor.
  void run(std::size_t count, const std::function<void(std::size_t)>& task);

 private:
  struct alignas(64) Share {
    std::atomic<std::size_t> next = 0;  // to be begun
    std::size_t end = 0;
  };
  struct Job {
    const std::function<void(std::size_t)>* task;
    std::span<Share> shares;               // one a thread; the caller's is the first
    std::atomic<std::size_t> helpers = 0;  // that work on it beside the caller; they come and go under mutex_

    void work(std::size_t own);  // from that share on
    bool can_use_help() const;
  };

  void help(std::size_t own);
  Job* pick();  // null: none can use help, or as many threads work as there may; under mutex_
  void await_job(BusyPoll& busy, std::size_t jobs) const;  // beyond those so far
  void await_helpers(const Job& job) const;

  const std::size_t threads_at_work_;  // at most, callers included
  const std::chrono::microseconds busy_poll_;
  std::mutex mutex_;
  std::condition_variable job_is_here_, helper_left_;
  std::vector<Job*> jobs_;                // that can use help
  std::size_t working_ = 0;               // callers and helpers; under mutex_
  std::atomic<std::size_t> jobs_so_far_;  // counted under mutex_
  bool stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace racebeam
