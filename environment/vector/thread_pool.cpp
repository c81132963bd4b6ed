#include "environment/vector/thread_pool.hpp"

#include "system/resources.hpp"

namespace racebeam {

ThreadPool::ThreadPool(unsigned threads) : shares_(threads != 0 ? threads : usable_processors().amount) {
  for (std::size_t thread = 1; thread < shares_.size(); ++thread)
    threads_.emplace_back([this, thread] { wait_for_work(thread); });
}

ThreadPool::~ThreadPool() {
  stopping_ = true;
  ++round_;
  round_.notify_all();
}

void ThreadPool::run_all(std::size_t count) {
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    shares_[i].next = count * i / shares_.size();
    shares_[i].end = count * (i + 1) / shares_.size();
  }
  busy_ = static_cast<std::uint32_t>(threads_.size());
  ++round_;
  round_.notify_all();
  work(0);
  for (std::uint32_t busy = busy_; busy != 0; busy = busy_) busy_.wait(busy);
}

// First the thread's own share, then what is left of the others'.
void ThreadPool::work(std::size_t own) {
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    Share& share = shares_[(own + i) % shares_.size()];
    for (;;) {
      const std::size_t number = share.next.fetch_add(1, std::memory_order_relaxed);
      if (number >= share.end) break;
      call_(context_, number);
    }
  }
}

// All threads finish a round before the next one begins, so that none can miss one.
void ThreadPool::wait_for_work(std::size_t own) {
  for (std::uint32_t seen = 0;;) {
    round_.wait(seen);
    ++seen;
    if (stopping_) return;
    work(own);
    if (--busy_ == 0) busy_.notify_one();
  }
}

}  // namespace racebeam
