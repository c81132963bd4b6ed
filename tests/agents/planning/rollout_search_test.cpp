#include "agents/planning/rollout_search.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "tests/agents/planning/toy_model.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

RolloutSettings settings(std::int64_t frames = 1000000) {
  return {.frames = frames, .discount = 0.995, .reward_scale = RewardScale::kNone};
}

// A line of 200 places; both actions at its far end give a reward. Elsewhere action 0 stays.
Arrow line(int place, int action) {
  if (place == 199) return {199, 1};
  return {place + action, 0};
}

}  // namespace

TEST_CASE("Rollout-IW(1) finds what is far away, and stops when nothing is new") {
  ToyModel model(2, line);
  RolloutSearch search(model, settings(), 1);
  CHECK(search.choose(ToyModel::place(0)) == 1);
  CHECK(search.exhausted());
  CHECK(search.nodes() == 1 + 2 * 200);  // as IW(1)
  CHECK(search.value(1) == Approx(std::pow(0.995, 199)));
  CHECK(search.frames() == 5 * 2 * 200);
}

TEST_CASE("Rollout-IW(1) ends with its frames") {
  ToyModel model(2, line);
  RolloutSearch search(model, settings(100), 1);
  search.choose(ToyModel::place(0));
  CHECK(search.frames() == 100);
  CHECK(!search.exhausted());
  CHECK(search.nodes() == 21);
}

TEST_CASE("Rollout-IW(1) ends with the nodes that a tree may have, whatever it has kept") {
  ToyModel model(2, line);
  RolloutSettings few = settings();
  few.most_nodes = 30;
  RolloutSearch search(model, few, 1);
  search.choose(ToyModel::place(0));
  CHECK(search.nodes() == 30);
  CHECK(search.frames() == 5 * 29);
  search.keep(1, ToyModel::place(1));
  const std::size_t kept = search.nodes();
  REQUIRE(kept < 30);
  search.choose(ToyModel::place(1));
  CHECK(search.nodes() == 30);
  CHECK(search.frames() == 5 * static_cast<std::int64_t>(30 - kept));
}

TEST_CASE("A place is open on the shortest way to it only") {
  // Both ways lead to 10, action 1 by way of 1: what a detour found first is given up for the direct way.
  const auto world = [](int place, int action) -> Arrow {
    if (place == 0) return {action == 0 ? 10 : 1, 0};
    return {place == 1 ? 10 : place + 1, 0};
  };
  ToyModel model(2, world);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RolloutSearch search(model, settings(), seed);
    search.choose(ToyModel::place(0));
    CHECK(search.exhausted());
    search.keep(0, ToyModel::place(10));
    CHECK(search.nodes() >= 1 + 245);  // 11 to 255 at least
  }
}

TEST_CASE("Rollout-IW(1) keeps the subtree of its action, which costs nothing") {
  ToyModel model(2, line);
  RolloutSearch search(model, settings(), 1);
  search.choose(ToyModel::place(0));
  search.keep(1, ToyModel::place(1));
  CHECK(search.nodes() == 1 + 2 * 199);
  search.choose(ToyModel::place(1));
  CHECK(search.exhausted());
  CHECK(search.frames() == 0);
  search.keep(1, ToyModel::place(77));  // the world went elsewhere
  CHECK(search.nodes() == 0);
  RolloutSettings plain = settings();
  plain.reuse_tree = false;
  RolloutSearch forgets(model, plain, 1);
  forgets.choose(ToyModel::place(0));
  forgets.keep(1, ToyModel::place(1));
  CHECK(forgets.nodes() == 0);
}

TEST_CASE("Rollout-IW(1) chooses each of equal actions, and no action that ends the episode") {
  ToyModel model(3, [](int, int action) -> Arrow { return {0, 1, action == 2}; });
  RolloutSearch search(model, settings(), 1);
  std::map<int, int> chosen;
  for (int i = 0; i < 200; ++i) {
    search.forget();
    ++chosen[search.choose(ToyModel::place(0))];
  }
  REQUIRE(chosen.size() == 2);
  CHECK(chosen[0] == Approx(100).margin(35));
  CHECK(chosen[1] == 200 - chosen[0]);
}

TEST_CASE("Where the episode is over, Rollout-IW(1) chooses any action and runs no frame") {
  ToyModel model(3, [](int, int) -> Arrow { return {1, 1}; });
  RolloutSearch search(model, settings(), 1);
  std::map<int, int> chosen;
  for (int i = 0; i < 50; ++i) {
    search.forget();
    ++chosen[search.choose(ToyModel::place(0, true))];
  }
  CHECK(chosen.size() == 3);
  CHECK(search.frames() == 0);
}

TEST_CASE("Rollout-IW(1) looks behind a trap") {
  ToyModel model(2, trap);
  CHECK(RolloutSearch(model, settings(), 1).choose(ToyModel::place(0)) == 1);
}

TEST_CASE(
    "Rollout-IW(1) keeps nothing below an action that ended the episode, and nothing without a search") {
  ToyModel model(2, end_or_on);
  RolloutSettings hasty = settings();
  hasty.discount = 0.5;
  RolloutSearch search(model, hasty, 1);
  CHECK(search.value(0) == 0);
  search.keep(0, ToyModel::place(0));
  REQUIRE(search.choose(ToyModel::place(0)) == 0);
  REQUIRE(search.nodes() > 0);
  search.keep(0, ToyModel::place(1, true));
  CHECK(search.nodes() == 0);
}
