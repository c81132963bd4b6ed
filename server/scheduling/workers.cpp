#include "server/scheduling/workers.hpp"

#include <algorithm>

namespace racebeam {

Workers::Workers(unsigned threads, std::chrono::microseconds busy_poll)
    : threads_at_work_(std::max(1U, threads)), busy_poll_(busy_poll), jobs_so_far_(0) {
  for (unsigned thread = 1; thread < threads; ++thread)
    threads_.emplace_back([this, thread] { help(thread); });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  job_is_here_.notify_all();
}

void Workers::run(std::size_t count, const std::function<void(std::size_t)>& task) {
  static thread_local std::vector<Share> shares;  // for its memory
  if (shares.size() <= threads_.size()) shares = std::vector<Share>(threads_.size() + 1);
  Job job{&task, std::span(shares).first(threads_.size() + 1)};
  for (std::size_t i = 0; i < job.shares.size(); ++i) {
    job.shares[i].next = count * i / job.shares.size();
    job.shares[i].end = count * (i + 1) / job.shares.size();
  }
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(&job);
    ++jobs_so_far_;
    ++working_;
  }
  job_is_here_.notify_all();
  job.work(0);
  std::unique_lock lock(mutex_);
  std::erase(jobs_, &job);
  if (job.helpers != 0) {
    lock.unlock();
    await_helpers(job);
    lock.lock();
  }
  helper_left_.wait(lock, [&job] { return job.helpers == 0; });
  --working_;
}

void Workers::Job::work(std::size_t own) {
  for (std::size_t i = 0; i < shares.size(); ++i) {
    Share& share = shares[(own + i) % shares.size()];
    for (;;) {
      const std::size_t number = share.next.fetch_add(1, std::memory_order_relaxed);
      if (number >= share.end) break;
      (*task)(number);
    }
  }
}

bool Workers::Job::can_use_help() const {
  return std::ranges::any_of(shares, [](const Share& share) { return share.next < share.end; });
}

Workers::Job* Workers::pick() {
  if (working_ >= threads_at_work_) return nullptr;
  const auto found = std::ranges::find_if(jobs_, [](const Job* job) { return job->can_use_help(); });
  return found == jobs_.end() ? nullptr : *found;
}

// Whoever else wants the processor has it: the client is one of them.
void Workers::await_job(BusyPoll& busy, std::size_t jobs) const {
  for (busy.begin(); busy.again() && jobs_so_far_ == jobs;) std::this_thread::yield();
}

// They are at their last task.
void Workers::await_helpers(const Job& job) const {
  const auto end = BusyPoll::Clock::now() + busy_poll_;
  while (job.helpers != 0 && BusyPoll::Clock::now() < end) std::this_thread::yield();
}

void Workers::help(std::size_t own) {
  BusyPoll busy(busy_poll_);
  bool quick = false;  // the last job came soon after the one before
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
    quick = busy.came_after(BusyPoll::Clock::now() - idle);
    job->work(own);
    lock.lock();
    --working_;
    if (--job->helpers == 0) helper_left_.notify_all();
  }
}

}  // namespace racebeam
