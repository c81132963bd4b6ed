#include "system/file_lock.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <thread>

#include "system/regular_file.hpp"
#include "tests/games/scratch.hpp"

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

// How many descriptors of this process are of the file at the path.
int descriptors_of(const std::string& path) {
  constexpr int kEnough = 256;
  int count = 0;
  for (int file = 0; file < kEnough; ++file) count += is_at(file, path) ? 1 : 0;
  return count;
}

// Waits for something that another thread does to descriptors.
template <class Done>
void wait_until(const Done& done) {
  if (!std::filesystem::exists("/dev/fd"))
    return std::this_thread::sleep_for(100ms);  // they cannot be counted
  while (!done()) std::this_thread::yield();
}

}  // namespace

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
  wait_until([&] { return descriptors_of(path) == 2; });  // it locks the file that is about to go
  std::filesystem::remove(path);
  auto second = std::make_optional<FileLock>(path);
  first.reset();
  wait_until([&] { return has_it || descriptors_of(path) == 2; });  // it has opened the next one
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

TEST_CASE("Who has not locked a file or a folder sees whether another one has") {
  const Scratch place;
  const std::string path = place.path("a.lock");
  for (const bool folder : {false, true}) {
    const auto open = [&] { return folder ? open_lock_of_folder(place.path(".")) : open_lock(path); };
    const int holder = open(), other = open();
    REQUIRE((holder >= 0 && other >= 0));
    CHECK_FALSE(is_locked(other));
    close_file(other);  // which may have locked it to find out
    CHECK(lock_file(holder, Waiting::kNo));
    const int late = open();
    CHECK(is_locked(late));
    CHECK_FALSE(lock_file(late, Waiting::kNo));
    CHECK(is_locked_elsewhere(errno));
    close_file(holder);
    CHECK_FALSE(is_locked(late));
    close_file(late);
  }
  CHECK(open_lock_of_folder(path) == -1);
  CHECK_FALSE(is_locked(-1));
}

TEST_CASE("An open file is at its path until it is removed or replaced") {
  const Scratch place;
  const std::string path = place.path("a.lock");
  const int file = open_lock(path);
  CHECK(is_at(file, path));
  CHECK_FALSE(is_at(file, place.write("other", "")));
  std::filesystem::rename(path, place.path("renamed"));
  CHECK_FALSE(is_at(file, path));
  const int next = open_lock(path);
  CHECK_FALSE(is_at(file, path));
  CHECK(is_at(next, path));
  close_file(file);
  close_file(next);
}
