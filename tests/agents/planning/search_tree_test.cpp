#include "agents/planning/search_tree.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "tests/agents/planning/toy_model.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

TreeSettings settings(std::int64_t expansions, int actions) {
  return {.frames = 5 * expansions * actions, .discount = 0.5, .reward_scale = RewardScale::kNone};
}

}  // namespace

TEST_CASE("A full tree looks behind a trap") {
  ToyModel model(2, trap);
  TreeSearch shallow(model, settings(1, 2), 1);
  CHECK(shallow.choose(ToyModel::place(0)) == 0);
  TreeSearch deep(model, settings(3, 2), 1);
  CHECK(deep.choose(ToyModel::place(0)) == 1);
}

TEST_CASE("The values of a tree of five nodes are those computed by hand") {
  // The root leads to A (reward 2) and B (0); A leads to C (-4) and D (1).
  const auto world = [](int place, int action) -> Arrow {
    if (place == 0) return action == 0 ? Arrow{1, 2} : Arrow{2, 0, true};
    return action == 0 ? Arrow{3, -4, true} : Arrow{4, 1, true};
  };
  ToyModel model(2, world);
  TreeSearch search(model, settings(2, 2), 1);
  CHECK(search.choose(ToyModel::place(0)) == 0);
  CHECK(search.nodes() == 5);
  CHECK(search.value(0) == 2.5);  // 2 + 1/2 max(-4, 1)
  CHECK(search.value(1) == 0);
  CHECK(search.frames() == 20);
}

TEST_CASE("What follows the end of an episode has no value") {
  ToyModel model(2, end_or_on);
  TreeSettings patient = settings(1000, 2);
  patient.discount = 0.9;
  CHECK(TreeSearch(model, patient, 1).choose(ToyModel::place(0)) == 1);  // 1 + 0.9 + ... > 5
  CHECK(TreeSearch(model, settings(1000, 2), 1).choose(ToyModel::place(0)) == 0);
}

TEST_CASE("Of equal actions each is chosen") {
  ToyModel model(3, [](int, int) -> Arrow { return {0, 1}; });
  TreeSearch search(model, settings(4, 3), 1);
  std::map<int, int> chosen;
  for (int i = 0; i < 300; ++i) ++chosen[search.choose(ToyModel::place(0))];
  REQUIRE(chosen.size() == 3);
  for (const auto& [action, count] : chosen) CHECK(count == Approx(100).margin(35));
}

// 18 actions with 3 effects: merged, level n has 18 * 3^(n-1) nodes, of which 3^n are expanded.
TEST_CASE("A world where 18 actions have 3 effects grows like 3 when duplicates are merged") {
  ToyModel model(18, [](int place, int action) -> Arrow { return {3 * place + action % 3 + 1, 0}; });
  for (const int levels : {1, 2, 3, 4}) {
    int expansions = 0, merged = 1, level = 1;
    for (int i = 0; i < levels; ++i, level *= 3) expansions += level;
    merged += 18 * expansions;
    TreeSettings merging = settings(expansions, 18);
    merging.merge_duplicates = true;
    TreeSearch search(model, merging, 1);
    search.choose(ToyModel::place(0));
    CHECK(search.nodes() == static_cast<std::size_t>(merged));
    CHECK(search.frames() == 5 * 18 * expansions);
  }
  TreeSearch plain(model, settings(1 + 18, 18), 1);
  plain.choose(ToyModel::place(0));
  CHECK(plain.nodes() == 1 + 18 + 18 * 18);
}

TEST_CASE("The paper's budget is three whole levels and a part of the fourth") {
  ToyModel model(18, [](int place, int action) -> Arrow { return {18 * place + action + 1, 0}; });
  TreeSearch search(model, {.frames = 133000}, 1);
  search.choose(ToyModel::place(0));
  CHECK(search.frames() == 133020);  // the last node is expanded whole
  CHECK(search.nodes() == 1 + 133020 / 5);
}

TEST_CASE("IW(1) expands places with a new byte only, and finds what is far away") {
  // A line of 200 places; both actions at its far end give a reward. Elsewhere action 0 stays.
  const auto line = [](int place, int action) -> Arrow {
    if (place == 199) return {199, 1};
    return action == 0 ? Arrow{place, 0} : Arrow{place + 1, 0};
  };
  ToyModel model(2, line);
  TreeSettings narrow = settings(100000, 2);
  narrow.discount = 0.995;
  narrow.needs_novelty = true;
  TreeSearch search(model, narrow, 1);
  CHECK(search.choose(ToyModel::place(0)) == 1);
  CHECK(search.nodes() == 1 + 2 * 200);
  narrow.needs_novelty = false;
  narrow.frames = 5 * 2 * 200;
  TreeSearch wide(model, narrow, 1);
  wide.choose(ToyModel::place(0));
  CHECK(wide.value(1) == 0);  // the same frames do not reach it
}

TEST_CASE("A checkpoint without the order of actions is refused") {
  ToyModel model(2, trap);
  TreeSearch search(model, settings(1, 2), 1);
  StateWriter old;
  old.put(Random(1));
  old.put(RewardScaler(RewardScale::kNone));
  StateReader in(old.bytes());
  CHECK_THROWS_WITH(search.read(in), "it ends too early");
  old.put(std::vector<int>{0, 5});
  StateReader wrong(old.bytes());
  CHECK_THROWS_WITH(search.read(wrong), "its order of actions is none");
}

TEST_CASE("Values are the same with and without merging, in a world of penalties too") {
  // 6 actions with 3 effects. Each step costs 1 to 3, so that what is not looked at would seem best.
  ToyModel model(6, [](int place, int action) -> Arrow {
    return {3 * place + action % 3 + 1, -1.0 - (place + action % 3) % 3};
  });
  for (const int levels : {1, 2, 3}) {
    int plain_expansions = 0, merged_expansions = 0;
    for (int i = 0, wide = 1, narrow = 1; i < levels; ++i, wide *= 6, narrow *= 3) {
      plain_expansions += wide;
      merged_expansions += narrow;
    }
    TreeSettings merging = settings(merged_expansions, 6);
    merging.merge_duplicates = true;
    TreeSearch plain(model, settings(plain_expansions, 6), 1), merged(model, merging, 2);
    plain.choose(ToyModel::place(0));
    merged.choose(ToyModel::place(0));
    for (int action = 0; action < 6; ++action) {
      INFO(levels << " levels, action " << action);
      CHECK(merged.value(action) == plain.value(action));
    }
  }
}
