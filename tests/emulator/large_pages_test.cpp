#include "emulator/base/large_pages.hpp"

#ifdef __linux__
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdint>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "system/pages.hpp"

using racebeam::large_pages_in_use;
using racebeam::LargePageScope;
using racebeam::MachineVector;
using racebeam::Paging;

namespace {

using Bytes = MachineVector<std::uint8_t>;

constexpr std::size_t kKiB = 1024, kMiB = kKiB * kKiB;

// The number of pages where the system has large ones, else 0.
std::size_t pages(std::size_t count) { return racebeam::can_prefer_large_pages() ? count : 0; }

bool holds_only(const Bytes& block, std::uint8_t byte) {
  return std::ranges::all_of(block, [byte](std::uint8_t each) { return each == byte; });
}

}  // namespace

TEST_CASE("Memory is in large pages while there are many machines") {
  REQUIRE(large_pages_in_use() == 0);
  CHECK((Bytes(kKiB), large_pages_in_use() == 0));
  {
    const LargePageScope few(7);
    CHECK((Bytes(kKiB), large_pages_in_use() == 0));
    const Bytes small(kKiB);
    CHECK(large_pages_in_use() == 0);
  }
  std::optional<LargePageScope> many(8), more(64);
  const Bytes block(kKiB);
  CHECK(large_pages_in_use() == pages(1));
  many.reset();
  const Bytes next(kMiB - 2 * kKiB);
  CHECK(large_pages_in_use() == pages(1));
  more.reset();
  const Bytes later(kMiB / 2);
  CHECK(large_pages_in_use() == pages(1));
}

TEST_CASE("A large page is given back with its last block, after the machines too") {
  std::optional<LargePageScope> many(8);
  std::vector<Bytes> blocks;
  for (int i = 0; i < 50; ++i) blocks.emplace_back(100 * kKiB);
  CHECK(large_pages_in_use() == pages(3));  // 20 blocks each
  many.reset();
  blocks.erase(blocks.begin(), blocks.begin() + 19);
  CHECK(large_pages_in_use() == pages(3));
  blocks.erase(blocks.begin());
  CHECK(large_pages_in_use() == pages(2));
  blocks.clear();
  CHECK(large_pages_in_use() == 0);
}

TEST_CASE("A free block is used again for one of its size") {
  const LargePageScope many(8);
  const Bytes first(kKiB);
  std::optional freed = Bytes(kMiB / 2, std::uint8_t{1});
  const std::uint8_t* const place = freed->data();
  freed.reset();
  const Bytes other(kMiB / 4), same(kMiB / 2);
  if (racebeam::can_prefer_large_pages()) CHECK(same.data() == place);
  CHECK(other.data() != place);
  CHECK(holds_only(same, 0));
}

TEST_CASE("Free blocks of a page that is given back are forgotten") {
  const LargePageScope many(8);
  for (int round = 0; round < 3; ++round) {
    std::vector<Bytes> blocks;
    for (int i = 0; i < 40; ++i) blocks.emplace_back(100 * kKiB, std::uint8_t(i));
    blocks.erase(blocks.begin(), blocks.begin() + 20);  // the whole first page
    const std::vector<Bytes> others(20, Bytes(100 * kKiB, std::uint8_t{99}));
    for (std::size_t i = 0; i < blocks.size(); ++i)
      CHECK(holds_only(blocks[i], static_cast<std::uint8_t>(20 + i)));
  }
  CHECK(large_pages_in_use() == 0);
}

TEST_CASE("Large blocks and those with the usual paging are in no large page") {
  const LargePageScope many(8);
  const Bytes large(kMiB), usual(kKiB, Paging::kUsual);
  CHECK(large_pages_in_use() == 0);
  const Bytes largest(kMiB - 2 * kKiB);
  CHECK(large_pages_in_use() == pages(1));
  const Bytes copy(largest, Paging::kUsual);
  CHECK(copy == largest);
  CHECK(large_pages_in_use() == pages(1));
}

TEST_CASE("Blocks are aligned and apart") {
  const LargePageScope many(8);
  std::vector<Bytes> blocks;
  for (std::size_t size = 1; size < 300; ++size) blocks.emplace_back(size, static_cast<std::uint8_t>(size));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    CHECK(reinterpret_cast<std::uintptr_t>(blocks[i].data()) % 64 == 0);
    CHECK(holds_only(blocks[i], static_cast<std::uint8_t>(i + 1)));
  }
}

TEST_CASE("Threads allocate and give back at the same time") {
  const LargePageScope many(8);
  std::vector<std::thread> threads;
  std::vector<int> wrong(4);
  for (int number = 0; number < 4; ++number)
    threads.emplace_back([number, &wrong] {
      std::vector<Bytes> blocks(16);
      for (std::size_t i = 0; i < 4000; ++i) {
        Bytes& block = blocks[i * 7 % blocks.size()];
        if (!holds_only(block, static_cast<std::uint8_t>(number))) ++wrong[static_cast<std::size_t>(number)];
        block = Bytes(i % 5 * 10 * kKiB + 100, static_cast<std::uint8_t>(number));
      }
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(std::reduce(wrong.begin(), wrong.end()) == 0);
  CHECK(large_pages_in_use() == 0);
}

#ifdef __linux__
TEST_CASE("A copy of the process allocates and gives back while a thread of the first one did") {
  const LargePageScope many(8);
  std::atomic<int> rounds = 0;
  std::atomic<bool> is_over = false;
  std::thread thread([&] {
    for (; !is_over; ++rounds) Bytes(100);
  });
  while (rounds == 0) std::this_thread::yield();
  std::optional<Bytes> block(kKiB);
  int failed = 0;
  for (int i = 0; i < 100; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::alarm(20);  // ends a copy that waits for the thread's lock
      block.reset();
      for (int size = 1; size < 100; ++size) Bytes(static_cast<std::size_t>(size) * kKiB);
      ::_exit(0);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    if (status != 0) ++failed;
  }
  is_over = true;
  thread.join();
  CHECK(failed == 0);
}
#endif
