// Batch on our own image. Beside this, test_batch.py compares with the reference's vector environment.
#include "environment/vector/batch.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "environment/observe/area_resize.hpp"
#include "environment/vector/thread_pool.hpp"
#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Cartridge> copies(std::size_t count) { return {count, {test::counter_image(), test::game()}}; }

BatchSettings short_episodes() {
  BatchSettings settings;
  settings.machine.random_seed = 5;
  settings.machine.sticky = 0.25F;
  settings.max_episode_frames = 30;
  settings.noop_max = 7;
  return settings;
}

void play(Batch& batch, int steps) {
  std::mt19937 random(3);
  std::vector<int> actions(batch.size());
  for (int step = 0; step < steps; ++step) {
    for (int& action : actions) action = static_cast<int>(random() % batch.actions(0).size());
    batch.step(actions);
  }
}

TEST_CASE("Every task runs once in each round, whatever the number of threads") {
  for (const unsigned count : {1U, 2U, 5U}) {
    ThreadPool threads(count);
    CHECK(threads.threads() == count);
    for (int round = 0; round < 300; ++round) {
      std::vector<std::atomic<int>> runs(static_cast<std::size_t>(round));
      threads.run(runs.size(), [&runs](std::size_t number) { ++runs[number]; });
      REQUIRE(std::ranges::all_of(runs, [](const auto& run) { return run == 1; }));
    }
  }
}

TEST_CASE("A batch gives the same on one thread and on several") {
  auto settings = short_episodes();
  settings.screens = true;
  settings.threads = 1;
  Batch alone(copies(7), settings);
  settings.threads = 3;
  Batch together(copies(7), settings);
  play(alone, 40);
  play(together, 40);
  const auto &a = alone.results(), &b = together.results();
  CHECK(a.observations == b.observations);
  CHECK(a.screens == b.screens);
  CHECK(a.ram == b.ram);
  CHECK(a.frames == b.frames);
  CHECK(std::ranges::count(a.ram, a.ram[0]) != std::ssize(a.ram));
}

TEST_CASE("The machines of a batch have seeds of their own, one after the other") {
  auto settings = short_episodes();
  Batch three(copies(3), settings);
  settings.machine.random_seed += 2;
  Batch last(copies(1), settings);
  play(three, 0);
  CHECK(three.results().frames[2] == last.results().frames[0]);
  const std::vector<std::int32_t>& frames = three.results().frames;
  CHECK_FALSE((frames[0] == frames[1] && frames[1] == frames[2]));
}

TEST_CASE("After an episode a machine resets in the next step, in the same one, or when it is told to") {
  auto settings = short_episodes();
  settings.machine.sticky = 0;
  settings.frame_skip = 10;
  settings.noop_max = 0;
  settings.fire_at_reset = false;
  const std::vector<int> noop{0};
  const auto counters = [&](Autoreset autoreset) {
    settings.autoreset = autoreset;
    Batch batch(copies(1), settings);
    std::vector<std::array<int, 3>> seen;  // episode frame, truncated, finished
    for (int step = 0; step < 5; ++step) {
      batch.step(noop);
      const auto& results = batch.results();
      seen.push_back({results.episode_frames[0], results.truncated[0], results.finished[0]});
    }
    return seen;
  };
  using Seen = std::vector<std::array<int, 3>>;
  CHECK(counters(Autoreset::kNextStep) == Seen{{10, 0, 0}, {20, 0, 0}, {30, 1, 1}, {0, 0, 0}, {10, 0, 0}});
  CHECK(counters(Autoreset::kSameStep) == Seen{{10, 0, 0}, {20, 0, 0}, {0, 1, 1}, {10, 0, 0}, {20, 0, 0}});
  CHECK(counters(Autoreset::kDisabled) == Seen{{10, 0, 0}, {20, 0, 0}, {30, 1, 1}, {30, 1, 1}, {30, 1, 1}});

  settings.autoreset = Autoreset::kDisabled;
  Batch batch(copies(2), settings);
  for (int step = 0; step < 3; ++step) batch.step(std::vector{0, 0});
  batch.reset(std::vector<std::uint8_t>{0, 1});
  CHECK(batch.results().episode_frames == std::vector{30, 0});
  CHECK(batch.results().finished == Bytes{1, 0});
  batch.reset();
  CHECK(batch.results().finished == Bytes{0, 0});
}

TEST_CASE("A batch says what it can't do, and goes on") {
  Batch batch(copies(2), short_episodes());
  const auto before = batch.results().frames;
  CHECK_THROWS_WITH(batch.step(std::vector{0}), "there are 1 actions for 2 machines");
  CHECK_THROWS_WITH(batch.step(std::vector{0, 18}), "machine 1 has no action 18; it takes 0 to 17");
  CHECK_THROWS_WITH(batch.step(std::vector{-1, 0}), "machine 0 has no action -1; it takes 0 to 17");
  CHECK_THROWS_WITH(batch.reset(Bytes(3)), "there are 3 choices for 2 machines");
  CHECK(batch.results().frames == before);
  auto settings = short_episodes();
  settings.frame_skip = 0;
  CHECK_THROWS_WITH(Batch(copies(1), settings), "a step has 0 frames; it must have 1 or more");
  settings = short_episodes();
  settings.mode = 2;
  CHECK_THROWS_WITH(Batch(copies(3), settings), Catch::Contains("no mode 2; it offers 0, 1, 3"));
}

// Rows that repeat, and noise.
Bytes picture(std::mt19937& random, std::size_t width, std::size_t height) {
  Bytes bytes;
  while (bytes.size() < width * height) {
    Bytes row(width);
    for (auto& cell : row) cell = static_cast<std::uint8_t>(random());
    for (auto times = 1 + random() % 6; times > 0; --times) bytes.insert(bytes.end(), row.begin(), row.end());
  }
  bytes.resize(width * height);
  return bytes;
}

TEST_CASE("Every form of the area average gives the same bytes") {
  std::mt19937 random(8);
  const int sizes[][4] = {{160, 210, 84, 84}, {160, 250, 84, 84}, {160, 230, 84, 84}, {160, 210, 100, 50},
                          {160, 210, 160, 210}, {160, 210, 21, 8}, {17, 9, 16, 5}, {7, 9, 3, 2}};
  for (const auto& [width, height, to_width, to_height] : sizes) {
    const Bytes in = picture(random, std::size_t(width), std::size_t(height));
    Bytes best(std::size_t(to_width * to_height)), plain(best.size());
    AreaResize(width, height, to_width, to_height)(in, best);
    AreaResize(width, height, to_width, to_height, Simd::kPlain)(in, plain);
    INFO(width << " x " << height << " to " << to_width << " x " << to_height);
    CHECK(best == plain);
  }
  CHECK_THROWS_WITH(AreaResize(160, 210, 161, 84), Catch::Contains("can't be made 161 x 84"));
  CHECK_THROWS_WITH(AreaResize(160, 210, 84, 7), Catch::Contains("can't be made 84 x 7"));
}

}  // namespace
}  // namespace racebeam
