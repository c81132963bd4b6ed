#include "system/file_lock.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/games/scratch.hpp"

using namespace racebeam;
using namespace std::chrono_literals;

TEST_CASE("One process at a time holds a lock") {
  const Scratch place;
  const std::string path = place.path("a.lock");
  auto lock = FileLock::attempt(path);
  REQUIRE(lock);
  CHECK_FALSE(FileLock::attempt(path));
  lock.reset();
  CHECK(FileLock::attempt(path));
}

TEST_CASE("A process that waits for a file that its holder removes locks the one that is there next") {
  const Scratch place;
  const std::string path = place.path("a.lock");
  auto first = std::make_optional<FileLock>(path);
  std::atomic<bool> has_it = false;
  std::jthread waits([&] {
    const FileLock lock(path);
    has_it = true;
  });
  std::this_thread::sleep_for(100ms);  // it waits for the file that is about to go
  std::filesystem::remove(path);
  auto second = std::make_optional<FileLock>(path);
  first.reset();
  std::this_thread::sleep_for(100ms);
  CHECK_FALSE(has_it);
  second.reset();
  waits.join();
  CHECK(has_it);
}

TEST_CASE("A lock in a folder that is gone says so") {
  const Scratch place;
  CHECK_THROWS_WITH(FileLock(place.path("gone/a.lock")),
                    Catch::StartsWith("cannot make " + place.path("gone/a.lock")));
}
