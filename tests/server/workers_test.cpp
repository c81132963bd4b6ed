#include "server/scheduling/workers.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

using namespace racebeam;
using namespace std::chrono_literals;

TEST_CASE("Every task runs once, and all are done when run returns") {
  const auto busy_poll = GENERATE(0us, 100us);
  for (const unsigned threads : {1U, 2U, 5U}) {
    Workers workers(threads, busy_poll);
    for (const std::size_t count : {0UL, 1UL, 3UL, 1000UL}) {
      std::vector<std::atomic<int>> runs(count);
      workers.run(count, [&runs](std::size_t number) { ++runs[number]; });
      for (const auto& run : runs) CHECK(run == 1);
    }
  }
}

TEST_CASE("Several threads can have tasks at the same time") {
  Workers workers(3, GENERATE(0us, 100us));
  std::atomic<int> done = 0;
  std::vector<std::jthread> sessions;
  for (int session = 0; session < 4; ++session) {
    sessions.emplace_back([&] {
      for (int round = 0; round < 500; ++round) {
        std::atomic<int> mine = 0;
        workers.run(7, [&mine](std::size_t) { ++mine; });
        if (mine == 7) ++done;
      }
    });
  }
  sessions.clear();
  CHECK(done == 2000);
}
