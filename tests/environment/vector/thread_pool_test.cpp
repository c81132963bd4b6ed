#include "environment/vector/thread_pool.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <map>
#include <mutex>
#include <numeric>
#include <thread>

#include "system/affinity.hpp"

using namespace racebeam;
using namespace std::chrono_literals;

TEST_CASE("Every task runs once, and all are done when run returns") {
  const auto busy_poll = GENERATE(0us, 100us);
  for (const unsigned threads : {1U, 2U, 5U}) {
    ThreadPool pool(threads, busy_poll);
    CHECK(pool.threads() == threads);
    for (const std::size_t count : {0UL, 1UL, 3UL, 1000UL}) {
      std::vector<std::atomic<int>> runs(count);
      pool.run(count, [&runs](std::size_t number) { ++runs[number]; });
      for (const auto& run : runs) CHECK(run == 1);
    }
  }
}

TEST_CASE("Several threads can have tasks at the same time") {
  ThreadPool pool(3, GENERATE(0us, 100us));
  std::atomic<int> done = 0;
  std::vector<std::jthread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&] {
      for (int round = 0; round < 500; ++round) {
        std::atomic<int> mine = 0;
        pool.run(7, [&mine](std::size_t) { ++mine; });
        if (mine == 7) ++done;
      }
    });
  }
  callers.clear();
  CHECK(done == 2000);
}

TEST_CASE("A queue runs each task once, on the pool's threads or the caller's") {
  for (const unsigned threads : {1U, 3U}) {
    ThreadPool pool(threads, 0us, 0);
    std::vector<std::atomic<int>> runs(500);
    std::atomic<std::size_t> done = 0;
    ThreadPool::Queue queue(pool, [&](std::size_t number) { ++runs[number], ++done; });
    std::vector<std::size_t> numbers(runs.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    for (std::size_t at = 0; at < numbers.size(); at += 50) queue.push(std::span(numbers).subspan(at, 50));
    while (done < runs.size()) {
      if (!queue.work_once()) std::this_thread::yield();
    }
    for (const auto& run : runs) CHECK(run == 1);
  }
}

TEST_CASE("A queue that goes drops what was not begun, and awaits what was") {
  constexpr int kTasks = 100'000;  // four minutes of two threads: a busy machine holds up this one for less
  ThreadPool pool(2);
  std::atomic<int> begins = 0, ended = 0;
  {
    ThreadPool::Queue queue(pool, [&](std::size_t) {
      ++begins;
      std::this_thread::sleep_for(5ms);
      ++ended;
    });
    queue.push(std::vector<std::size_t>(kTasks));
    while (begins == 0) std::this_thread::yield();
  }
  CHECK(begins == ended);
  CHECK(begins < kTasks);
}

TEST_CASE("Threads are bound one after the other, and to the first after the last") {
  const std::vector<unsigned> allowed = allowed_processors();
  const auto threads = static_cast<unsigned>(2 * allowed.size() + 1);
  ThreadPool pool(threads, 0us, 1);
  std::mutex mutex;
  std::map<std::vector<unsigned>, int> counts;
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<unsigned> inside = 0;
  pool.run(threads, [&](std::size_t) {
    for (++inside; inside < threads;) std::this_thread::yield();
    const std::lock_guard lock(mutex);
    if (std::this_thread::get_id() != caller) ++counts[allowed_processors()];
  });
  for (const unsigned processor : allowed) CHECK(counts[{processor}] == 2);
}
