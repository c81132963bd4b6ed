#include "racebeam/snapshot.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/library/beamfall.hpp"

using racebeam::Environment;
using racebeam::Snapshot;

namespace {

std::vector<std::uint8_t> observation(Environment& environment) {
  return {environment.screen().begin(), environment.screen().end()};
}

}  // namespace

TEST_CASE("A restored environment shows the same picture and the same future") {
  auto environment = beamfall::environment();
  beamfall::score_of(environment, 30);
  const Snapshot snapshot = environment.save();
  const auto screen = observation(environment);
  const int score = beamfall::score_of(environment, 50);
  const auto later = observation(environment);

  environment.restore(snapshot);
  CHECK(observation(environment) == screen);
  CHECK(beamfall::score_of(environment, 50) == score);
  CHECK(observation(environment) == later);
}

TEST_CASE("The bytes of a snapshot restore it in another environment") {
  racebeam::Settings settings = beamfall::settings();
  settings.screens = racebeam::Screens::kOnDemand;  // so that the bytes need pictures that were not drawn
  Environment environment(beamfall::image(), settings);
  beamfall::score_of(environment, 30);
  const auto bytes = environment.save().to_bytes();
  CHECK(Snapshot::from_bytes(bytes).to_bytes() == bytes);

  auto other = beamfall::environment();
  other.restore(Snapshot::from_bytes(bytes));
  CHECK(observation(other) == observation(environment));
  CHECK(other.state_hash() == environment.state_hash());
  CHECK(beamfall::score_of(other, 50) == beamfall::score_of(environment, 50));
}

TEST_CASE("A snapshot of an environment has the portable form of a state") {
  auto environment = beamfall::environment();
  const auto bytes = environment.save().to_bytes();
  CHECK(std::string(bytes.begin(), bytes.begin() + 8) == "RBSTATE\n");  // docs/states.md
}

TEST_CASE("A snapshot has the generator of sticky actions on request") {
  racebeam::Settings settings = beamfall::settings();
  settings.sticky = 0.5F;
  Environment environment(beamfall::image(), settings);
  const auto futures = [&](bool with_random) {
    const Snapshot snapshot = environment.save(with_random);
    std::vector<std::uint64_t> hashes;
    for (int time = 0; time < 4; ++time) {
      environment.restore(snapshot);
      for (int step = 0; step < 40; ++step)
        environment.step(step % 2 ? racebeam::Action::kLeft : racebeam::Action::kRight);
      hashes.push_back(environment.state_hash());
    }
    return std::ranges::count(hashes, hashes[0]);
  };
  CHECK(futures(true) == 4);
  CHECK(futures(false) < 4);
}

TEST_CASE("Threads restore one snapshot, each in its own environment") {
  auto environment = beamfall::environment();
  beamfall::score_of(environment, 30);
  const Snapshot snapshot = environment.save();
  std::vector<int> scores(4);
  {
    std::vector<std::jthread> threads;
    for (int& score : scores) {
      threads.emplace_back([&score, snapshot] {
        auto own = beamfall::environment();
        own.restore(snapshot);
        score = beamfall::score_of(own, 70);
      });
    }
  }
  CHECK(scores == std::vector(4, beamfall::score_of(environment, 70)));
}
