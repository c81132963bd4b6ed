#include "environment/vector/thread_pool.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>

#include "system/affinity.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

unsigned number_of_threads(unsigned requested) {
  return requested != 0 ? requested : static_cast<unsigned>(usable_processors().amount);
}

}  // namespace

// The job of one run(): numbers from 0, in one share for each thread. The caller has the first share. The job
// owns the shares: with MinGW, a thread's variables may be released before their destructors run.
class ThreadPool::Round final : public Job {
 public:
  Round(const Task& task, std::size_t count, std::size_t threads)
      : task_(task),
        many_(threads > few_.size() ? threads : 0),
        shares_(many_.empty() ? std::span(few_).first(threads) : std::span(many_)) {
    for (std::size_t i = 0; i < threads; ++i) {
      shares_[i].next = count * i / threads;
      shares_[i].end = count * (i + 1) / threads;
    }
  }

  bool can_use_help() const override {
    return std::ranges::any_of(shares_, [](const Share& share) { return share.next < share.end; });
  }

  void work(std::size_t own) override {
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      Share& share = shares_[(own + i) % shares_.size()];
      for (;;) {
        const std::size_t number = share.next.fetch_add(1, std::memory_order_relaxed);
        if (number >= share.end) break;
        task_(number);
      }
    }
  }

 private:
  const Task& task_;
  std::array<Share, 16> few_;  // without an allocation
  std::vector<Share> many_;    // where these are too few
  const std::span<Share> shares_;
};

ThreadPool::ThreadPool(unsigned threads, std::chrono::microseconds busy_poll, int first_processor)
    : count_(number_of_threads(threads)), busy_poll_(busy_poll) {
  try {
    start(first_processor);
  } catch (...) {
    stop();
    throw;
  }
}

ThreadPool::~ThreadPool() { stop(); }

// The caller of run() is the first thread.
void ThreadPool::start(int first_processor) {
  const std::vector<unsigned> allowed = first_processor >= 0 ? allowed_processors() : std::vector<unsigned>();
  for (unsigned thread = 1; thread < count_; ++thread) {
    start_one(thread);
    if (allowed.empty()) continue;
    const std::size_t number = static_cast<std::size_t>(first_processor) + thread - 1;
    bind_to(threads_.back(), allowed[number % allowed.size()]);
  }
}

void ThreadPool::start_one(unsigned thread) {
  try {
    threads_.emplace_back([this, thread] { help(thread); });
  } catch (const std::system_error& error) {
    throw std::system_error(error.code(), "thread " + std::to_string(thread + 1) + " of " +
                                              std::to_string(count_) + " could not be started");
  }
}

void ThreadPool::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  job_is_here_.notify_all();
}

void ThreadPool::add(Job& job) {
  const std::lock_guard lock(mutex_);
  jobs_.push_back(&job);
}

void ThreadPool::announce() {
  {
    const std::lock_guard lock(mutex_);
    ++jobs_so_far_;
  }
  job_is_here_.notify_all();
}

void ThreadPool::remove(Job& job) {
  std::unique_lock lock(mutex_);
  std::erase(jobs_, &job);
  if (job.helpers != 0) {
    lock.unlock();
    await_helpers(job);
    lock.lock();
  }
  helper_left_.wait(lock, [&job] { return job.helpers == 0; });
}

void ThreadPool::run(std::size_t count, const Task& task) {
  Round round(task, count, threads());
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(&round);
    ++jobs_so_far_;
    ++working_;
  }
  job_is_here_.notify_all();
  round.work(0);
  remove(round);
  const std::lock_guard lock(mutex_);
  --working_;
}

ThreadPool::Job* ThreadPool::pick() {
  if (working_ >= threads()) return nullptr;
  const auto found = std::ranges::find_if(jobs_, [](const Job* job) { return job->can_use_help(); });
  return found == jobs_.end() ? nullptr : *found;
}

// Yields the processor to others, since the client may be one of them.
void ThreadPool::await_job(BusyPoll& busy, std::size_t jobs) const {
  for (busy.begin(); busy.again() && jobs_so_far_ == jobs;) std::this_thread::yield();
}

// Polls briefly, since the helpers are at their last task.
void ThreadPool::await_helpers(const Job& job) const {
  const auto end = BusyPoll::Clock::now() + busy_poll_;
  while (job.helpers != 0 && BusyPoll::Clock::now() < end) std::this_thread::yield();
}

void ThreadPool::help(std::size_t own) {
  BusyPoll busy(busy_poll_);
  bool quick = false;  // the last job came soon after its predecessor
  std::unique_lock lock(mutex_);
  for (;;) {
    const auto idle = BusyPoll::Clock::now();
    if (quick && pick() == nullptr) {
      const std::size_t jobs = jobs_so_far_;
      lock.unlock();
      await_job(busy, jobs);
      lock.lock();
    }
    Job* job = nullptr;
    job_is_here_.wait(lock, [&] { return stopping_ || (job = pick()) != nullptr; });
    if (stopping_) return;
    ++job->helpers;
    ++working_;
    lock.unlock();
    quick = busy.received_after(BusyPoll::Clock::now() - idle);
    job->work(own);
    lock.lock();
    --working_;
    if (--job->helpers == 0) helper_left_.notify_all();
  }
}

ThreadPool::Queue::Queue(ThreadPool& pool, Task task) : pool_(pool), task_(std::move(task)) {
  pool_.add(*this);
}

ThreadPool::Queue::~Queue() {
  {
    const std::lock_guard lock(mutex_);
    numbers_.clear();
    waiting_ = 0;
  }
  pool_.remove(*this);
}

void ThreadPool::Queue::push(std::span<const std::size_t> numbers) {
  {
    const std::lock_guard lock(mutex_);
    numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
    waiting_ = numbers_.size();
  }
  pool_.announce();
}

bool ThreadPool::Queue::work_once() {
  std::size_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    if (numbers_.empty()) return false;
    number = numbers_.front();
    numbers_.pop_front();
    waiting_ = numbers_.size();
  }
  task_(number);
  return true;
}

void ThreadPool::Queue::work(std::size_t) {
  while (work_once()) continue;
}

}  // namespace racebeam
