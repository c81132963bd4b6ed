#include "system/program/gate.hpp"

#include <catch2/catch.hpp>
#include <deque>
#include <thread>

using namespace racebeam;

// With wait() of std::atomic_flag, the first rounds hang on Windows.
TEST_CASE("A thread that waits at a gate goes on when it opens, however close the two calls are") {
  constexpr int kRounds = 2000;
  std::deque<Gate> there(kRounds), back(kRounds);
  std::thread other([&] {
    for (int i = 0; i < kRounds; ++i) {
      there[i].wait();
      back[i].open();
    }
  });
  for (int i = 0; i < kRounds; ++i) {
    there[i].open();
    back[i].wait();
  }
  other.join();
  CHECK(back.back().is_open());
}

TEST_CASE("A gate is closed at first, and lets through all who come after it has opened") {
  Gate gate;
  CHECK_FALSE(gate.is_open());
  gate.open();
  CHECK(gate.is_open());
  gate.wait();
  gate.wait();
}
