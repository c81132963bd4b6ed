#include "protocol/running/fiber.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace racebeam;

TEST_CASE("A fiber runs until it is suspended, and goes on from there") {
  Fiber fiber;
  std::string order;
  CHECK_FALSE(fiber.start([&] {
    order += 'a';
    fiber.suspend();
    order += 'b';
    fiber.suspend();
    order += 'c';
  }));
  CHECK(order == "a");
  CHECK(fiber.in_progress());
  CHECK_FALSE(fiber.resume());
  CHECK(order == "ab");
  CHECK(fiber.resume());
  CHECK(order == "abc");
  CHECK_FALSE(fiber.in_progress());
}

TEST_CASE("A fiber that is never suspended is done at once, and can start again") {
  Fiber fiber;
  int calls = 0;
  for (int n = 0; n < 1000; ++n) REQUIRE(fiber.start([&] { ++calls; }));
  CHECK(calls == 1000);
}

TEST_CASE("What a fiber throws and catches is its own affair") {
  Fiber fiber;
  int caught = 0;
  CHECK_FALSE(fiber.start([&] {
    for (int n = 0; n < 3; ++n) {
      try {
        fiber.suspend();
        throw std::runtime_error("one");
      } catch (const std::runtime_error&) {
        ++caught;
      }
    }
  }));
  try {
    fiber.resume();
    throw std::logic_error("the caller's");
  } catch (const std::logic_error&) {
    CHECK(caught == 1);
  }
  CHECK_FALSE(fiber.resume());
  CHECK(fiber.resume());
  CHECK(caught == 3);
}

TEST_CASE("What a body throws ends it, and reaches the caller of start or resume") {
  Fiber fiber;
  CHECK_THROWS_AS(fiber.start([] { throw std::bad_alloc(); }), std::bad_alloc);
  CHECK_FALSE(fiber.in_progress());
  CHECK_FALSE(fiber.start([&] {
    fiber.suspend();
    throw std::runtime_error("no more");
  }));
  CHECK_THROWS_WITH(fiber.resume(), "no more");
  CHECK_FALSE(fiber.in_progress());
  CHECK(fiber.start([] {}));
}

TEST_CASE("What a cancelled body throws is ignored") {
  Fiber fiber;
  CHECK_FALSE(fiber.start([&] {
    try {
      fiber.suspend();
    } catch (...) {
      throw std::runtime_error("while it unwinds");
    }
  }));
  fiber.cancel();
  CHECK_FALSE(fiber.in_progress());
}

TEST_CASE("A fiber that is cancelled unwinds its stack") {
  const auto witness = std::make_shared<int>(0);
  bool went_on = false;
  {
    Fiber fiber;
    fiber.start([&fiber, &went_on, mine = witness] {
      const auto also_mine = mine;
      fiber.suspend();
      went_on = true;
    });
    CHECK(witness.use_count() > 1);
  }
  CHECK(witness.use_count() == 1);
  CHECK_FALSE(went_on);
}

// Not inlined: a compiler may assume that a function stays on its thread.
[[gnu::noinline]] void note_thread(std::vector<std::thread::id>& threads) {
  threads.push_back(std::this_thread::get_id());
}

TEST_CASE("A fiber goes on on another thread") {
  Fiber fiber;
  std::vector<std::thread::id> threads;
  fiber.start([&] {
    note_thread(threads);
    fiber.suspend();
    note_thread(threads);
  });
  std::thread([&] { CHECK(fiber.resume()); }).join();
  REQUIRE(threads.size() == 2);
  CHECK(threads[0] != threads[1]);
}

TEST_CASE("Many fibers are in progress at a time") {
  std::vector<std::unique_ptr<Fiber>> fibers;
  int ended = 0;
  for (int n = 0; n < 300; ++n) {
    fibers.push_back(std::make_unique<Fiber>());
    Fiber& fiber = *fibers.back();
    fiber.start([&] {
      fiber.suspend();
      ++ended;
    });
  }
  for (const auto& fiber : fibers) CHECK(fiber->resume());
  CHECK(ended == 300);
}
