#include "system/busy_poll.hpp"

#include <catch2/catch.hpp>
#include <thread>

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

constexpr auto kLong = 50ms;  // enough for one look at least, though the machine is busy

// How many looks until it gives up.
int looks(BusyPoll& busy) {
  int count = 0;
  for (busy.begin(); busy.again(); ++count) std::this_thread::sleep_for(1ms);
  return count;
}

}  // namespace

TEST_CASE("A busy poll begins only when asked, and lasts no longer than told") {
  BusyPoll busy(kLong);
  CHECK_FALSE(busy.again());
  const auto begin = BusyPoll::Clock::now();
  CHECK(looks(busy) >= 1);
  CHECK(BusyPoll::Clock::now() - begin >= kLong);
  CHECK_FALSE(busy.again());
}

TEST_CASE("Only who asked again within that time is worth it") {
  BusyPoll busy(100us), never(0us);
  CHECK(busy.received_after(99us));
  CHECK_FALSE(busy.received_after(100us));
  CHECK_FALSE(never.received_after(0us));
}

TEST_CASE("What is in vain is tried ever more seldom, until it was not") {
  BusyPoll busy(kLong);
  int tries = 0;
  for (int turn = 0; turn < 30; ++turn) tries += looks(busy) > 0;
  CHECK(tries == 3);  // before 4, 20 and 84 that are left out
  while (!busy.again()) busy.begin();
  for (int turn = 0; turn < 10; ++turn) busy.received_after(1ms);
  tries = 0;
  for (int turn = 0; turn < 6; ++turn) tries += looks(busy) > 0;
  CHECK(tries == 2);
}
