#include "racebeam/vector.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "racebeam/error.hpp"
#include "tests/library/beamfall.hpp"

using racebeam::VectorEnvironment;
using racebeam::VectorResults;
using racebeam::VectorSettings;

namespace {

VectorEnvironment environments(std::size_t count, const VectorSettings& settings = {}) {
  const auto image = beamfall::image();
  return {image, racebeam::Game::recognise(image), count, settings};
}

// Episodes begin as those of a single machine do, and screens are its screens.
VectorSettings as_single() {
  VectorSettings settings;
  settings.machine = beamfall::settings();
  settings.noop_max = 0;
  settings.fire_at_reset = false;
  settings.stack = 1;
  settings.width = settings.height = 0;
  settings.rgb = true;
  settings.max_pool = false;
  return settings;
}

std::vector<std::uint8_t> rgb(racebeam::Environment& environment) {
  std::vector<std::uint8_t> out(environment.observation_size(racebeam::Pixels::kRgb));
  environment.observe(racebeam::Pixels::kRgb, out);
  return out;
}

int fire(const VectorEnvironment& vector) {
  const auto actions = vector.actions(0);
  return static_cast<int>(std::ranges::find(actions, racebeam::Action::kFire) - actions.begin());
}

}  // namespace

TEST_CASE("Machines step together, and all results are written") {
  auto vector = environments(3);
  VectorResults results = vector.make_results();
  CHECK(vector.size() == 3);
  CHECK(vector.batch_size() == 3);
  CHECK(vector.observation_size() == 4 * 84 * 84);
  CHECK(results.observations.size() == 3 * vector.observation_size());
  vector.reset(results);
  const std::vector<int> actions(3, fire(vector));
  int score = 0;
  for (int step = 0; step < 40; ++step) {
    vector.step(actions, results);
    score += std::accumulate(results.rewards.begin(), results.rewards.end(), 0);
  }
  CHECK(score > 0);
  CHECK(results.lives == std::vector<std::int32_t>(3, 4));
  CHECK(results.machines == std::vector<std::int32_t>{0, 1, 2});
  CHECK(std::ranges::any_of(results.observations, [](auto pixel) { return pixel != 0; }));
}

TEST_CASE("Arrays that are left empty are not written, and others must have the size") {
  auto vector = environments(2);
  std::vector<std::int32_t> rewards(2);
  const std::vector<int> actions(2, 0);
  vector.step(actions, {.rewards = rewards});
  std::vector<std::int32_t> wrong(3);
  CHECK_THROWS_WITH(vector.step(actions, {.rewards = wrong}),
                    "rewards has 3 elements; it must have 2, or none");
  CHECK_THROWS_AS(vector.step(std::vector<int>{99, 0}, {}), racebeam::Error);
  CHECK_THROWS_AS(vector.step(std::vector<int>{0}, {}), racebeam::Error);
  CHECK_THROWS_AS(vector.actions(2), racebeam::Error);
  CHECK_THROWS_AS(vector.save(2), racebeam::Error);
}

TEST_CASE("An array of a wrong size is refused by name, and nothing is run") {
  auto vector = environments(2);
  const VectorResults before = [&] {
    VectorResults results = vector.make_results();
    vector.reset(results);
    return results;
  }();
  const std::vector<int> actions(2, 0);
  const auto refused = [&](const std::string& name, auto VectorResults::*array) {
    VectorResults wrong = vector.make_results();
    wrong.final_observations = wrong.observations;  // which only Autoreset::kSameStep makes
    const std::size_t size = (wrong.*array).size();
    (wrong.*array).pop_back();
    const std::string sentence = name + " has " + std::to_string(size - 1) + " elements; it must have " +
                                 std::to_string(size) + ", or none";
    CHECK_THROWS_WITH(vector.step(actions, wrong), sentence);
    CHECK_THROWS_WITH(vector.reset(wrong), sentence);
    CHECK_THROWS_WITH(vector.observe(wrong), sentence);
    CHECK_THROWS_WITH(vector.receive(wrong), sentence);
  };
  refused("observations", &VectorResults::observations);
  refused("final_observations", &VectorResults::final_observations);
  refused("ram", &VectorResults::ram);
  refused("rewards", &VectorResults::rewards);
  refused("lives", &VectorResults::lives);
  refused("episode_frames", &VectorResults::episode_frames);
  refused("terminated", &VectorResults::terminated);
  refused("truncated", &VectorResults::truncated);
  refused("machines", &VectorResults::machines);
  VectorResults now = vector.make_results();
  vector.observe(now);
  CHECK(now.ram == before.ram);
}

TEST_CASE("A machine that the vector does not have is refused by number") {
  auto vector = environments(2);
  const auto snapshot = vector.save(1);
  CHECK(vector.actions(1) == vector.actions(0));
  for (const std::size_t number : {2, 9}) {
    const std::string sentence = "machine " + std::to_string(number) + " is out of range; accepted: 0 to 1";
    CHECK_THROWS_WITH(vector.actions(number), sentence);
    CHECK_THROWS_WITH(vector.save(number), sentence);
    CHECK_THROWS_WITH(vector.restore(number, snapshot), sentence);
  }
}

TEST_CASE("A machine of a vector has the results of a single one") {
  auto vector = environments(2, as_single());
  auto single = beamfall::environment();
  VectorResults results = vector.make_results();
  vector.reset(results);
  const std::vector<int> actions = {fire(vector), 0};
  for (int step = 0; step < 20; ++step) {
    vector.step(actions, results);
    CHECK(results.rewards[0] == single.step(racebeam::Action::kFire));
    CHECK(results.episode_frames[0] == single.episode_frames());
    CHECK(results.lives[0] == single.lives());
  }
  CHECK(std::ranges::equal(single.ram(), std::span(results.ram).first(racebeam::kRamSize)));
  CHECK(std::ranges::equal(rgb(single), std::span(results.observations).first(vector.observation_size())));
  CHECK_FALSE(std::ranges::equal(std::span(results.ram).first(racebeam::kRamSize),
                                 std::span(results.ram).last(racebeam::kRamSize)));
}

TEST_CASE("A limit of frames truncates a step, which gives what was seen last and the next beginning") {
  VectorSettings settings = as_single();
  settings.machine.max_episode_frames = 8;
  settings.autoreset = racebeam::Autoreset::kSameStep;
  auto vector = environments(1, settings);
  VectorResults results = vector.make_results();
  vector.reset(results);
  const auto beginning = results.observations;
  const std::vector<int> fires = {fire(vector)};
  vector.step(fires, results);
  CHECK(results.truncated == std::vector<std::uint8_t>{0});
  const auto seen_last = results.observations;
  vector.step(fires, results);
  CHECK(results.truncated == std::vector<std::uint8_t>{1});
  CHECK(results.terminated == std::vector<std::uint8_t>{0});
  CHECK(std::ranges::equal(results.final_observations, seen_last));
  CHECK(std::ranges::equal(results.observations, beginning));
  CHECK_FALSE(std::ranges::equal(seen_last, beginning));
}

TEST_CASE("A lost life terminates the step in which it is lost, and the game continues") {
  VectorSettings settings = as_single();
  settings.life_loss = racebeam::LifeLoss::kReported;
  auto vector = environments(1, settings);
  VectorResults results = vector.make_results();
  vector.reset(results);
  const std::vector<int> fires = {fire(vector)};
  int lost = 0;
  for (int step = 0, lives = results.lives[0]; step < 100; ++step) {
    vector.step(fires, results);
    CHECK(results.terminated[0] == (results.lives[0] < lives ? 1 : 0));
    lost += lives - results.lives[0];
    lives = results.lives[0];
  }
  CHECK(lost > 0);
  CHECK(results.episode_frames[0] == 400);
}

TEST_CASE("One machine goes back to a snapshot, in memory and as bytes") {
  auto vector = environments(2);
  VectorResults results = vector.make_results();
  vector.reset(results);
  const std::vector<int> actions(2, fire(vector));
  for (int step = 0; step < 20; ++step) vector.step(actions, results);
  const auto snapshot = vector.save(0, true);
  const auto observations = results.observations;
  const auto play = [&] {
    for (int step = 0; step < 20; ++step) vector.step(actions, results);
    return std::vector(results.observations.begin(), results.observations.begin() + 84 * 84 * 4);
  };
  const auto future = play();
  for (const auto& again : {snapshot, racebeam::Snapshot::from_bytes(snapshot.to_bytes())}) {
    vector.restore(0, again);
    vector.observe(results);
    CHECK(std::equal(observations.begin(), observations.begin() + 84 * 84 * 4, results.observations.begin()));
    CHECK(play() == future);
  }
}

TEST_CASE("A machine of a vector and a single one take each other's snapshots") {
  VectorSettings settings;
  settings.stack = 0;
  auto vector = environments(1, settings);
  auto single = beamfall::environment();
  vector.step(std::vector{fire(vector)}, {});
  single.restore(vector.save(0));
  beamfall::score_of(single, 10);
  vector.restore(0, single.save());
  vector.restore(0, racebeam::Snapshot::from_bytes(single.save().to_bytes()));

  auto with_stack = environments(1);
  CHECK_THROWS_AS(with_stack.restore(0, single.save()), racebeam::Error);  // it has no stack of screens
}

TEST_CASE("Those that finish first are received first") {
  VectorSettings settings;
  settings.batch_size = 2;
  settings.threads = 2;
  auto vector = environments(4, settings);
  VectorResults results = vector.make_results();
  CHECK(results.rewards.size() == 2);
  std::vector<std::int32_t> machines(4);
  std::iota(machines.begin(), machines.end(), 0);
  vector.send(std::vector<int>(4, 0), machines);
  CHECK_THROWS_AS(vector.step(std::vector<int>(4, 0), {}), racebeam::Error);  // they play
  std::vector<int> received(4);
  for (int time = 0; time < 20; ++time) {
    vector.receive(results);
    for (const auto machine : results.machines) ++received[static_cast<std::size_t>(machine)];
    vector.send(std::vector<int>(2, 0), results.machines);
  }
  CHECK(std::ranges::all_of(received, [](int count) { return count > 0; }));
}

TEST_CASE("A single machine's snapshot brings the random numbers of sticky actions on request") {
  VectorSettings settings = as_single();
  settings.machine.sticky = 0.5F;
  settings.stack = 0;
  auto vector = environments(1, settings);
  racebeam::Environment single(beamfall::image(), settings.machine);
  beamfall::score_of(single, 10);
  const auto futures = [&](bool with_random) {
    const auto snapshot = single.save(with_random);
    VectorResults results = vector.make_results();
    std::vector<std::vector<std::uint8_t>> memories;
    for (int time = 0; time < 4; ++time) {
      vector.restore(0, snapshot);
      for (int step = 0; step < 40; ++step) vector.step(std::vector{step % 2 * fire(vector)}, results);
      memories.push_back(results.ram);
    }
    return std::ranges::count(memories, memories[0]);
  };
  CHECK(futures(true) == 4);
  CHECK(futures(false) < 4);
}

TEST_CASE("Two games play in one vector") {
  const auto one = beamfall::image(), other = racebeam::Image::load("builtin:updraft");
  const std::vector<racebeam::Cartridge> cartridges = {{one, racebeam::Game::recognise(one)},
                                                       {other, racebeam::Game::recognise(other)}};
  VectorEnvironment vector(cartridges);
  VectorResults results = vector.make_results();
  vector.reset(results, std::vector<std::int64_t>{1, 2});
  vector.reset(results, {}, std::vector<std::uint8_t>{0, 1});
  CHECK(results.lives[0] > 0);
}
