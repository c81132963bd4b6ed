// A thread pool for the machines of vector environments. One pool serves any number of callers: a caller's
// job is done by the caller and by the threads that are idle.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "system/busy_poll.hpp"

namespace racebeam {

class ThreadPool {
  class Job {
   public:
    virtual ~Job() = default;
    virtual bool can_use_help() const = 0;
    virtual void work(std::size_t thread) = 0;  // returns when nothing is left to begin

    std::atomic<std::size_t> helpers = 0;  // threads on it beside the caller; changed under mutex_
  };

 public:
  // Called with a number; must not throw.
  using Task = std::function<void(std::size_t number)>;

  // threads: how many, counting the caller of run(); 0: one for each processor that the process may use.
  // Throws std::system_error if one of them cannot be started, and InvalidInput if it cannot be bound; the
  // others have ended then.
  // busy_poll: how long a thread polls for the next job before it sleeps. first_processor: the pool's own
  // threads are bound to this processor and those after it, counted from 0 among the processors that the
  // caller may use; after the last comes the first. -1: to none.
  explicit ThreadPool(unsigned threads, std::chrono::microseconds busy_poll = {}, int first_processor = -1);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  unsigned threads() const { return count_; }

  // Runs task(0) ... task(count - 1) and returns when all are done. Thread-safe. Every thread begins with its
  // own share, the same for the same count, so that a task's data stays in one processor's cache; a thread
  // that has finished helps the others. At most threads() work at a time, callers included: with more threads
  // than processors, a caller would wait for helpers that wait for a processor.
  void run(std::size_t count, const Task& task);

  // Tasks that are begun in the order of push(). The pool must outlive its queues.
  class Queue final : private Job {
   public:
    Queue(ThreadPool& pool, Task task);
    ~Queue() override;  // drops the tasks that were not begun, and waits for those in progress
    Queue(const Queue&) = delete;
    Queue& operator=(const Queue&) = delete;

    void push(std::span<const std::size_t> numbers);
    bool work_once();  // runs one task on the caller's thread; false if none waits

   private:
    friend class ThreadPool;
    bool can_use_help() const override { return waiting_ > 0; }
    void work(std::size_t thread) override;

    ThreadPool& pool_;
    const Task task_;
    std::mutex mutex_;
    std::deque<std::size_t> numbers_;
    std::atomic<std::size_t> waiting_ = 0;
  };

 private:
  struct alignas(64) Share {
    std::atomic<std::size_t> next = 0;  // the first task that was not begun
    std::size_t end = 0;
  };
  class Round;

  void stop();  // the threads end after the tasks they have begun
  void start(int first_processor);
  void start_one(unsigned thread);
  void add(Job& job);
  void remove(Job& job);  // waits for its helpers
  void announce();        // wakes threads, since there is more to do
  void help(std::size_t own);
  Job* pick();  // null if no job can use help, or threads() work already; under mutex_
  void await_job(BusyPoll& busy, std::size_t jobs) const;  // polls until jobs_so_far_ is not `jobs`
  void await_helpers(const Job& job) const;

  const unsigned count_;  // of threads, the caller of run() included; a thread reads it while others begin
  const std::chrono::microseconds busy_poll_;
  std::mutex mutex_;
  std::condition_variable job_is_here_, helper_left_;
  std::vector<Job*> jobs_;
  std::size_t working_ = 0;                   // callers and helpers; under mutex_
  std::atomic<std::size_t> jobs_so_far_ = 0;  // counted under mutex_
  bool stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace racebeam
