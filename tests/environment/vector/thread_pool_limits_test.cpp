// Limits that only POSIX sets for a process.
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <fstream>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>

#include "environment/vector/thread_pool.hpp"
#include "system/affinity.hpp"

using namespace racebeam;
using namespace std::chrono_literals;

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
