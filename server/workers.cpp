#include "server/workers.hpp"

#include <algorithm>

namespace racebeam {

Workers::Workers(unsigned threads) {
  for (unsigned thread = 1; thread < threads; ++thread) threads_.emplace_back([this] { help(); });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  job_is_here_.notify_all();
}

void Workers::run(std::size_t count, const std::function<void(std::size_t)>& task) {
  Job job{&task, count};
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(&job);
  }
  job_is_here_.notify_all();
  work(job);
  std::unique_lock lock(mutex_);
  std::erase(jobs_, &job);
  helper_left_.wait(lock, [&job] { return job.helpers == 0; });
}

void Workers::work(Job& job) {
  for (;;) {
    const std::size_t number = job.next.fetch_add(1, std::memory_order_relaxed);
    if (number >= job.count) return;
    (*job.task)(number);
  }
}

Workers::Job* Workers::pick() {
  const auto found = std::ranges::find_if(jobs_, [](const Job* job) { return job->next < job->count; });
  return found == jobs_.end() ? nullptr : *found;
}

void Workers::help() {
  std::unique_lock lock(mutex_);
  for (;;) {
    Job* job = nullptr;
    job_is_here_.wait(lock, [&] { return stopping_ || (job = pick()) != nullptr; });
    if (stopping_) return;
    ++job->helpers;
    lock.unlock();
    work(*job);
    lock.lock();
    if (--job->helpers == 0) helper_left_.notify_all();
  }
}

}  // namespace racebeam
