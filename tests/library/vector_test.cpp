#include "racebeam/vector.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
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
