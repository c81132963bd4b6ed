#include "environment/vector/thread_pool.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <system_error>
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

TEST_CASE("Threads are bound to the processors that the process may use") {
  const std::vector<unsigned> allowed = allowed_processors();
  cpu_set_t before, last;
  REQUIRE(::sched_getaffinity(0, sizeof before, &before) == 0);
  CPU_ZERO(&last);
  CPU_SET(allowed.back(), &last);
  REQUIRE(::sched_setaffinity(0, sizeof last, &last) == 0);
  CHECK(allowed_processors() == std::vector{allowed.back()});
  std::mutex mutex;
  std::set<std::vector<unsigned>> sets;
  {
    ThreadPool pool(3, 0us, GENERATE(0, 1, 5));
    std::atomic<int> inside = 0;
    pool.run(3, [&](std::size_t) {
      for (++inside; inside < 3;) std::this_thread::yield();  // each on its own thread
      const std::lock_guard lock(mutex);
      sets.insert(allowed_processors());
    });
  }
  REQUIRE(::sched_setaffinity(0, sizeof before, &before) == 0);
  CHECK(sets == std::set{std::vector{allowed.back()}});
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

#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)  // they need much address space themselves
TEST_CASE("A pool whose threads cannot all be started reports it, and leaves no thread") {
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_AS, &before) == 0);
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit little{pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + (100U << 20),
                      before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_AS, &little) == 0);
  std::string sentence;
  try {
    const ThreadPool pool(100'000);
  } catch (const std::system_error& error) {
    sentence = error.what();
  }
  REQUIRE(::setrlimit(RLIMIT_AS, &before) == 0);
  CHECK_THAT(sentence, Catch::Matches("thread [0-9]+ of 100000 could not be started: "
                                      "Resource temporarily unavailable"));
}
#endif
