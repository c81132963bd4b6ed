// Threads that stay, for work that is the same over and over: the machines of a Batch.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

namespace racebeam {

class ThreadPool {
 public:
  // The caller of run() is one of the threads. 0: one for each processor that the process may use.
  explicit ThreadPool(unsigned threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  unsigned threads() const { return static_cast<unsigned>(shares_.size()); }

  // Calls task(0) ... task(count - 1) and returns when all are done. Every thread has a share of its own, the
  // same each time, so that what a task uses stays in one processor's cache; who is done helps the others.
  // From one thread at a time. A task does not throw. Nothing is allocated.
  template <typename Task>
  void run(std::size_t count, Task&& task) {
    call_ = [](void* context, std::size_t number) {
      (*static_cast<std::remove_reference_t<Task>*>(context))(number);
    };
    context_ = &task;
    run_all(count);
  }

 private:
  struct alignas(64) Share {
    std::atomic<std::size_t> next = 0;  // to be begun
    std::size_t end = 0;
  };

  void run_all(std::size_t count);
  void work(std::size_t own);
  void wait_for_work(std::size_t own);

  void (*call_)(void*, std::size_t) = nullptr;
  void* context_ = nullptr;
  std::vector<Share> shares_;             // one a thread; the caller's is the first
  std::atomic<std::uint32_t> round_ = 0;  // counts calls of run(); its change wakes the threads
  std::atomic<std::uint32_t> busy_ = 0;   // threads, beside the caller, that have not finished the round
  std::atomic<bool> stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace racebeam
