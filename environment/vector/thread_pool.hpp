// Threads that stay, for the machines of vector environments. One pool serves any number of them: a caller's
// job is done by the caller and by those threads that have nothing else to do.
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
    virtual void work(std::size_t thread) = 0;  // until nothing is left to begin

    std::atomic<std::size_t> helpers = 0;  // that work on it beside the caller; they come and go under mutex_
  };

 public:
  // Work on task(number). Must not throw.
  using Task = std::function<void(std::size_t number)>;

  // The caller of run() is one of the threads. threads: 0: one for each processor that the process may use.
  // busy_poll: how long a thread waits awake for the next job; 0: never. first_processor: the pool's own
  // threads are bound to this processor and those after it; -1: to none.
  explicit ThreadPool(unsigned threads, std::chrono::microseconds busy_poll = {}, int first_processor = -1);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  unsigned threads() const { return static_cast<unsigned>(threads_.size()) + 1; }

  // Runs task(0) ... task(count - 1) and returns when all are done. Every thread begins with a share of its
  // own, the same for the same count, so that what a task uses stays in one processor's cache. A thread that
  // has finished helps the others. From any thread, also from several at once. Callers count among the
  // threads that work: more threads than processors would wait for helpers that wait for a processor.
  void run(std::size_t count, const Task& task);

  // Tasks that come one by one and are begun in that order. The pool outlives its queues.
  class Queue final : private Job {
   public:
    Queue(ThreadPool& pool, Task task);
    ~Queue();  // tasks that were not begun are dropped; those in progress are awaited
    Queue(const Queue&) = delete;
    Queue& operator=(const Queue&) = delete;

    void push(std::span<const std::size_t> numbers);
    bool work_once();  // begins one task on the caller's thread; false: there is none

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
    std::atomic<std::size_t> next = 0;  // to be begun
    std::size_t end = 0;
  };
  class Round;

  void add(Job& job);
  void remove(Job& job);  // and waits for its helpers
  void announce();        // there is more to do
  void help(std::size_t own);
  Job* pick();  // null: none can use help, or as many threads work as there may; under mutex_
  void await_job(BusyPoll& busy, std::size_t jobs) const;  // beyond those so far
  void await_helpers(const Job& job) const;

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
