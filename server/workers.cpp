#include "server/workers.hpp"

#include <algorithm>

namespace racebeam {

Workers::Workers(unsigned threads) {
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
  }
  job_is_here_.notify_all();
  job.work(0);
  std::unique_lock lock(mutex_);
  std::erase(jobs_, &job);
  helper_left_.wait(lock, [&job] { return job.helpers == 0; });
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
  const auto found = std::ranges::find_if(jobs_, [](const Job* job) { return job->can_use_help(); });
  return found == jobs_.end() ? nullptr : *found;
}

void Workers::help(std::size_t own) {
  std::unique_lock lock(mutex_);
  for (;;) {
    Job* job = nullptr;
    job_is_here_.wait(lock, [&] { return stopping_ || (job = pick()) != nullptr; });
    if (stopping_) return;
    ++job->helpers;
    lock.unlock();
    job->work(own);
    lock.lock();
    if (--job->helpers == 0) helper_left_.notify_all();
  }
}

}  // namespace racebeam
