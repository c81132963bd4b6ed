// Batch on our own image. Beside this, test_batch.py compares with the reference's vector environment.
#include "environment/vector/batch.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <random>

#include "emulator/base/large_pages.hpp"
#include "system/pages.hpp"
#include "system/resources.hpp"
#include "tests/environment/steered.hpp"
#include "tests/environment/vector/batches.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;
using test::copies, test::part, test::short_episodes;

// What the machines show after this many steps of random actions.
BatchResults play(Batch& batch, int steps) {
  std::mt19937 random(3);
  std::vector<int> actions(batch.size());
  BatchResults results = batch.make_results();
  batch.show(results.arrays());
  for (int step = 0; step < steps; ++step) {
    for (int& action : actions) action = static_cast<int>(random() % batch.actions(0).size());
    batch.step(actions, results.arrays());
  }
  return results;
}

void check_same(const BatchResults& a, const BatchResults& b) {
  CHECK(a.observations == b.observations);
  CHECK(a.final_observations == b.final_observations);
  CHECK(a.final_ram == b.final_ram);
  CHECK(a.screens == b.screens);
  CHECK(a.ram == b.ram);
  CHECK(a.rewards == b.rewards);
  CHECK(a.terminated == b.terminated);
  CHECK(a.truncated == b.truncated);
  CHECK(a.finished == b.finished);
  CHECK(a.frames == b.frames);
  CHECK(a.episode_frames == b.episode_frames);
}

TEST_CASE("A batch gives the same on one thread and on several") {
  auto settings = short_episodes();
  settings.screens = true;
  settings.threads = 1;
  Batch alone(copies(7), settings);
  settings.threads = 3;
  Batch together(copies(7), settings);
  const BatchResults a = play(alone, 40), b = play(together, 40);
  check_same(a, b);
  CHECK(std::ranges::count(a.ram, a.ram[0]) != std::ssize(a.ram));
}

TEST_CASE("A batch gives its large pages back, and a saved state keeps those of its pictures") {
  REQUIRE(large_pages_in_use() == 0);
  std::optional<Batch> batch(std::in_place, copies(64), short_episodes());
  play(*batch, 40);
  const auto all = large_pages_in_use();
  if (can_prefer_large_pages()) CHECK(all > 2);
  std::shared_ptr<const Environment::Saved> saved = batch->slot(0).environment().save();
  batch.reset();
  if (can_prefer_large_pages()) CHECK(large_pages_in_use() < all);
  saved.reset();
  CHECK(large_pages_in_use() == 0);
}

TEST_CASE("The machines of a batch have their own seeds, one after the other") {
  auto settings = short_episodes();
  Batch three(copies(3), settings);
  settings.slot.machine.random_seed += 2;
  Batch last(copies(1), settings);
  const std::vector<std::int32_t> frames = play(three, 0).frames;
  CHECK(frames[2] == play(last, 0).frames[0]);
  CHECK_FALSE((frames[0] == frames[1] && frames[1] == frames[2]));
}

TEST_CASE("After an episode a machine resets in the next step, in the same one, or when it is told to") {
  auto settings = short_episodes();
  settings.slot.machine.sticky = 0;
  settings.slot.machine.frame_skip = 10;
  settings.slot.noop_max = 0;
  settings.slot.fire_at_reset = false;
  const std::vector<int> noop{0};
  const auto counters = [&](Autoreset autoreset) {
    settings.autoreset = autoreset;
    Batch batch(copies(1), settings);
    BatchResults results = batch.make_results();
    std::vector<std::array<int, 3>> events;  // episode frame, truncated, finished
    for (int step = 0; step < 5; ++step) {
      batch.step(noop, results.arrays());
      events.push_back({results.episode_frames[0], results.truncated[0], results.finished[0]});
    }
    return events;
  };
  using Seen = std::vector<std::array<int, 3>>;
  CHECK(counters(Autoreset::kNextStep) == Seen{{10, 0, 0}, {20, 0, 0}, {30, 1, 1}, {0, 0, 0}, {10, 0, 0}});
  CHECK(counters(Autoreset::kSameStep) == Seen{{10, 0, 0}, {20, 0, 0}, {0, 1, 1}, {10, 0, 0}, {20, 0, 0}});
  CHECK(counters(Autoreset::kDisabled) == Seen{{10, 0, 0}, {20, 0, 0}, {30, 1, 1}, {30, 1, 1}, {30, 1, 1}});

  settings.autoreset = Autoreset::kDisabled;
  Batch batch(copies(2), settings);
  BatchResults results = batch.make_results();
  for (int step = 0; step < 3; ++step) batch.step(std::vector{0, 0}, results.arrays());
  batch.reset(results.arrays(), std::vector<std::uint8_t>{0, 1});
  CHECK(results.episode_frames == std::vector{30, 0});
  CHECK(results.finished == Bytes{1, 0});
  batch.reset(results.arrays());
  CHECK(results.finished == Bytes{0, 0});
}

TEST_CASE("A reset with a seed leads where a new batch with that seed begins") {
  auto settings = short_episodes();
  Batch played(copies(3), settings);
  play(played, 23);
  BatchResults results = played.make_results();
  played.reset(results.arrays(), {}, std::vector<std::int64_t>{90, 91, 92});
  settings.slot.machine.random_seed = 90;
  Batch fresh(copies(3), settings);
  check_same(results, play(fresh, 0));
  check_same(play(played, 50), play(fresh, 50));
  played.reset(results.arrays(), std::vector<std::uint8_t>{0, 1, 0}, std::vector<std::int64_t>{-1, 91, 5});
  Batch other(copies(3), settings);
  const BatchResults start = play(other, 0);
  CHECK(results.frames[1] == start.frames[1]);
  CHECK(results.frames[2] > start.frames[2]);
}

TEST_CASE("Results have clipped and unclipped rewards, and ends of lives beside ends of games") {
  auto settings = short_episodes();
  settings.slot.machine.sticky = 0;
  settings.slot.life_loss = LifeLoss::kReported;
  Batch batch(copies(2), settings);
  BatchResults results = batch.make_results();
  for (const std::size_t machine : {0, 1}) batch.slot(machine).environment().set_ram(test::kLives, 3);
  batch.step(std::vector{0, 0}, results.arrays());
  batch.slot(0).environment().set_ram(test::kScore, 7);
  batch.slot(0).environment().set_ram(test::kLives, 2);
  batch.slot(1).environment().set_ram(test::kOver, 1);
  batch.step(std::vector{0, 0}, results.arrays());
  CHECK(results.rewards == std::vector{1, 0});
  CHECK(results.raw_rewards == std::vector{7, 0});
  CHECK(results.terminated == Bytes{1, 1});
  CHECK(results.finished == Bytes{0, 1});
  CHECK(results.game_over == Bytes{0, 1});
}

TEST_CASE("The next step of an episode that the caller ended is a reset with the caller's seed") {
  const auto settings = short_episodes();
  Batch ended(copies(3), settings), reset(copies(3), settings);
  BatchResults results = ended.make_results(), expected = reset.make_results();
  const std::vector<std::int32_t> all{0, 1, 2};
  CHECK_THROWS_WITH(ended.end_episodes(all, std::vector<std::int64_t>{1}),
                    "there are 1 seeds for 3 machines");
  ended.end_episodes(all, std::vector<std::int64_t>{8, 3, 4});
  ended.end_episodes(all);  // keeps them
  ended.step(std::vector{1, 1, 1}, results.arrays());
  reset.reset(expected.arrays(), {}, std::vector<std::int64_t>{8, 3, 4});
  check_same(results, expected);
  CHECK(results.acts == std::vector{0, 0, 0});
  CHECK(results.elapsed == std::vector{0, 0, 0});
  for (int step = 1; step < 12; ++step) {  // the seed was for one reset
    ended.step(std::vector{1, 2, 3}, results.arrays());
    reset.step(std::vector{1, 2, 3}, expected.arrays());
    check_same(results, expected);
    if (step < 8) CHECK(results.elapsed[0] == std::min(4 * step, 30));
    CHECK(results.acts[0] == (step != 9));
  }
}

TEST_CASE("More machines than the memory has room for are refused") {
  CHECK_NOTHROW(check_memory(1));
  CHECK_THROWS_WITH(check_memory(std::size_t{1} << 30), Catch::Contains("1073741824 machines take about") &&
                                                            Catch::Contains("this process may use"));
}

TEST_CASE("A batch has no more threads than machines, however many are asked for") {
  auto settings = short_episodes();
  for (const auto& [threads, first_processor] : {std::pair(4'000'000'000U, 2'000'000'000), {3U, -7}}) {
    settings.threads = threads;
    settings.first_processor = first_processor;
    CHECK(Batch(copies(2), settings).threads() == 2);
  }
  settings.threads = 0;
  CHECK(Batch(copies(1), settings).threads() == 1);
}

// Steps of some hundreds of milliseconds.
BatchSettings long_steps() {
  auto settings = short_episodes();
  settings.slot.machine.frame_skip = 200'000;
  settings.slot.machine.max_episode_frames = 0;
  settings.slot.noop_max = 0;
  return settings;
}

void interrupt() { throw std::runtime_error("interrupted"); }

TEST_CASE("A long step ends when its caller wants it, and each machine has made it or is as it was") {
  auto settings = long_steps();
  settings.threads = GENERATE(1U, 2U);
  Batch batch(copies(8), settings);
  BatchResults results = batch.make_results();
  batch.show(results.arrays());
  const int begin = results.frames[0];
  batch.set_interrupt_check(interrupt);
  CHECK_THROWS_WITH(batch.step(std::vector<int>(8), results.arrays()), "interrupted");
  batch.set_interrupt_check(nullptr);
  batch.show(results.arrays());
  const auto are_at = [&](int frame) { return std::ranges::count(results.frames, frame); };
  CHECK(are_at(begin) > 0);
  CHECK(are_at(begin + 200'000) > 0);
  CHECK(are_at(begin) + are_at(begin + 200'000) == 8);
  batch.reset(results.arrays());
  CHECK(are_at(begin) == 0);
}

TEST_CASE("A receive that its caller ends has received nothing, and the machines play on") {
  auto settings = long_steps();
  settings.threads = 1;
  Batch batch(copies(2), settings);
  BatchResults results = batch.make_results();
  batch.send(std::vector{0, 0}, std::vector{0, 1});
  batch.set_interrupt_check(interrupt);
  CHECK_THROWS_WITH(batch.receive(results.arrays()), "interrupted");
  batch.set_interrupt_check(nullptr);
  CHECK_THROWS_WITH(batch.show(results.arrays()), "2 machines play; receive them first");
  batch.receive(results.arrays());
  CHECK(results.episode_frames[0] >= 200'000);
  CHECK(results.episode_frames[1] >= 200'000);
}

TEST_CASE("A machine of a batch goes back to a state, and plays on as it did") {
  for (const int frames : {30, 29}) {  // an episode ends with a step, or within one
    auto settings = short_episodes();
    settings.slot.machine.max_episode_frames = frames;
    Batch batch(copies(2), settings);
    play(batch, 5);
    const Slot::Saved saved = batch.slot(1).save(true);
    std::vector<BatchResults> first, second;
    for (auto* results : {&first, &second}) {
      for (int step = 0; step < 3; ++step) {
        results->push_back(batch.make_results());
        batch.step(std::vector{2, 3}, results->back().arrays());
      }
      batch.slot(1).restore(saved);
    }
    for (std::size_t step = 0; step < 3; ++step) {
      CHECK(part(first[step].observations, 1, 2) == part(second[step].observations, 1, 2));
      CHECK(part(first[step].ram, 1, 2) == part(second[step].ram, 1, 2));
      CHECK(first[step].finished[1] == second[step].finished[1]);
    }
    CHECK(first[2].finished[1] == 1);
  }
}

TEST_CASE("Lower screens of a batch are followed by zeros") {
  constexpr auto kLow = R"(
title = "Low"
[[image]]
height = 190
[rule]
step = "score = 0; terminal = 0"
)";
  std::vector<Cartridge> two = copies(1);
  two.push_back({test::counter_image(), test::game(kLow, "low")});
  BatchSettings settings;
  settings.screens = true;
  settings.stack = {.depth = 2, .width = 0, .height = 0, .rgb = true};
  Batch batch(two, settings);
  const int low = batch.slot(1).environment().height();
  REQUIRE(low < batch.height());
  CHECK(batch.observation_size() == std::size_t(2 * batch.height() * 160 * 3));
  BatchResults results = batch.make_results();
  std::ranges::fill(results.observations, std::uint8_t{77});
  std::ranges::fill(results.screens, std::uint8_t{77});
  batch.step(std::vector{0, 0}, results.arrays());
  const Bytes observation = part(results.observations, 1, 2), screen = part(results.screens, 1, 2);
  const std::size_t rows = std::size_t(batch.height() - low);
  const auto zeros = [](std::span<const std::uint8_t> bytes) {
    return std::ranges::count(bytes, 0) == std::ssize(bytes);
  };
  CHECK(zeros(std::span(observation).last(rows * 160 * 3)));
  CHECK(zeros(std::span(screen).last(rows * 160)));
  CHECK(std::ranges::count(observation, 77) < 1000);
}

TEST_CASE("A batch says what it can't do, and goes on") {
  Batch batch(copies(2), short_episodes());
  BatchResults results = batch.make_results();
  batch.show(results.arrays());
  const auto before = results.frames;
  const auto step = [&](const std::vector<int>& actions) { batch.step(actions, results.arrays()); };
  CHECK_THROWS_WITH(step({0}), "there are 1 actions for 2 machines");
  CHECK_THROWS_WITH(step({0, 18}), "machine 1 has no action 18; it takes 0 to 17");
  CHECK_THROWS_WITH(step({-1, 0}), "machine 0 has no action -1; it takes 0 to 17");
  CHECK_THROWS_WITH(batch.step(std::vector<Act>{{}, {.a = 40}}, results.arrays()),
                    "action 40 of player A is out of range; accepted: 0 to 25, and those of its controller");
  CHECK_THROWS_WITH(batch.step(std::vector<Act>{{}, {.b = 3}}, results.arrays()),
                    "action 3 of player B is out of range; accepted: 18 to 35, and those of its controller");
  for (const float strength : {NAN, INFINITY})
    CHECK_THROWS_WITH(
        batch.step(std::vector<Act>{{}, {.strength_a = strength}}, results.arrays()),
        "the strength of a paddle is " + std::to_string(strength) + "; it must be a finite number");
  CHECK_THROWS_WITH(batch.reset(results.arrays(), Bytes(3)), "there are 3 choices for 2 machines");
  CHECK_THROWS_WITH(batch.reset(results.arrays(), {}, std::vector<std::int64_t>(1)),
                    "there are 1 seeds for 2 machines");
  batch.show(results.arrays());
  CHECK(results.frames == before);
  const auto refuses = [](auto change, const std::string& sentence) {
    auto settings = short_episodes();
    change(settings);
    CHECK_THROWS_WITH(Batch(copies(3), settings), Catch::Contains(sentence));
  };
  refuses([](auto& s) { s.slot.machine.frame_skip = 0; }, "a step has 0 frames; it must have 1 or more");
  refuses([](auto& s) { s.slot.mode = 2; }, "no mode 2; it offers 0, 1, 3");
  refuses([](auto& s) { s.batch_size = 4; }, "batch_size is 4; it takes 1 to 3, or 0 for all");
  refuses([](auto& s) { s.stack.depth = -1; }, "the stack has -1 screens");
  refuses([](auto& s) { s.stack.width = 321; }, "the width of an observation is 321; it takes 1 to 320");
  CHECK_THROWS_WITH(Batch({}, short_episodes()), "there are 0 machines; there must be 1 or more");
  const std::size_t too_many = usable_memory().amount >> 17;  // each takes more than 128 KiB
  CHECK_THROWS_WITH(Batch(copies(too_many), short_episodes()),
                    Catch::Contains(std::to_string(too_many) + " machines take about"));
}

}  // namespace
}  // namespace racebeam
