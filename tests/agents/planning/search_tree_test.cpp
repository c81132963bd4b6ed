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
  CHECK_THROWS_WITH(search.read(wrong), "its order of actions is invalid");
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

namespace {

// A line of places. Action 1 goes on, and action 0 stays. Each place is new by its number.
Arrow along(int place, int action) { return {place + action, 0}; }

TreeSettings iw1(std::int64_t frames) {
  return {.frames = frames,
          .discount = 0.995,
          .needs_novelty = true,
          .reuse_tree = true,
          .reward_scale = RewardScale::kNone};
}

}  // namespace

TEST_CASE("A kept tree is that of the chosen child, and costs IW(1) no frames") {
  ToyModel model(2, along);
  TreeSearch search(model, iw1(100), 1);  // ten nodes are expanded
  search.choose(ToyModel::place(0));
  REQUIRE(search.nodes() == 21);
  search.keep(1, ToyModel::place(1));
  CHECK(search.nodes() == 19);  // without the root and the child that stayed
  search.choose(ToyModel::place(1));
  CHECK(search.frames() == 100);
  CHECK(search.nodes() == 39);
}

TEST_CASE("A tree expands no node while it has more nodes than it may, whatever it has kept") {
  ToyModel model(2, along);
  TreeSettings settings = iw1(1000);
  settings.most_nodes = 30;
  TreeSearch search(model, settings, 1);
  search.choose(ToyModel::place(0));
  CHECK(search.nodes() == 31);
  CHECK(search.frames() == 150);
  search.keep(1, ToyModel::place(1));
  REQUIRE(search.nodes() == 29);
  search.choose(ToyModel::place(1));
  CHECK(search.nodes() == 31);
  CHECK(search.frames() == 10);
}

TEST_CASE("Siblings in equal states share one") {
  // 6 actions with 3 effects
  ToyModel model(6, [](int place, int action) -> Arrow { return {3 * place + action % 3 + 1, 0}; });
  const bool merges = GENERATE(false, true);
  TreeSearch search(model, {.frames = 4 * 6 * 5, .merge_duplicates = merges, .reuse_tree = true}, 1);
  search.choose(ToyModel::place(0));
  CHECK(search.nodes() == 1 + 4 * 6);
  CHECK(model.states() == 4 * 3);
}

TEST_CASE("Breadth-first search counts the frames of the tree that it keeps") {
  ToyModel model(2, along);
  TreeSettings settings =
      iw1(300);  // 30 nodes are expanded: four levels of 1, 2, 4 and 8, and 15 of the next
  settings.needs_novelty = false;
  TreeSearch search(model, settings, 1);
  search.choose(ToyModel::place(0));
  REQUIRE(search.frames() == 300);
  search.keep(1, ToyModel::place(1));
  const std::size_t nodes = search.nodes();
  search.choose(ToyModel::place(1));
  CHECK(search.nodes() == 61);
  CHECK(search.frames() == 5 * static_cast<std::int64_t>(61 - nodes));
}

TEST_CASE("A kept tree gives the values of one that is built anew") {
  const auto world = [](int place, int action) -> Arrow {
    return {3 * place + action + 1, static_cast<double>((place * 7 + action * 5) % 11) - 4};
  };
  ToyModel model(3, world);
  TreeSettings settings{
      .frames = 5 * 3 * 13, .discount = 0.5, .reward_scale = RewardScale::kNone};  // 3 levels
  settings.merge_duplicates = GENERATE(false, true);
  TreeSettings reusing = settings;
  reusing.reuse_tree = true;
  TreeSearch anew(model, settings, 1), kept(model, reusing, 2);
  int place = 0;
  for (int decision = 0; decision < 3; ++decision) {
    anew.choose(ToyModel::place(place));
    const int action = kept.choose(ToyModel::place(place));
    for (int each = 0; each < 3; ++each) CHECK(kept.value(each) == anew.value(each));
    place = world(place, action).place;
    kept.keep(action, ToyModel::place(place));
  }
}

TEST_CASE("A tree is built anew if the world did not go where the tree did, or if nobody kept it") {
  ToyModel model(2, along);
  TreeSearch search(model, iw1(100), 1);
  search.choose(ToyModel::place(0));
  search.keep(1, ToyModel::place(5));
  search.choose(ToyModel::place(5));
  CHECK(search.nodes() == 21);
  search.choose(ToyModel::place(5));
  CHECK(search.nodes() == 21);
  TreeSettings plain = iw1(100);
  plain.reuse_tree = false;
  TreeSearch forgets(model, plain, 1);
  forgets.choose(ToyModel::place(0));
  forgets.keep(1, ToyModel::place(1));
  forgets.choose(ToyModel::place(1));
  CHECK(forgets.nodes() == 21);
}

// From 0, actions 0 and 1 lead to 256 and 257; from there, both lead to 512 + action. Their bytes: (0, 1),
// (1, 1), then (0, 2), (1, 2). So the children of the second one to be opened are pruned at first.
TEST_CASE("What was pruned in one search is looked at again in the next") {
  const auto world = [](int place, int action) -> Arrow {
    if (place == 0) return {256 + action, 0};
    if (place < 512) return {512 + action, 0};
    return {place + 256, 0};
  };
  ToyModel model(2, world);
  TreeSearch search(model, iw1(1000000), 1);
  search.choose(ToyModel::place(0));
  const std::size_t first = search.nodes();
  int second = 0;  // the action whose subtree is small
  for (const int action : {0, 1}) {
    TreeSearch copy(model, iw1(1000000), 1);
    copy.choose(ToyModel::place(0));
    copy.keep(action, ToyModel::place(256 + action));
    if (copy.nodes() == 3) second = action;
  }
  search.keep(second, ToyModel::place(256 + second));
  REQUIRE(search.nodes() == 3);
  search.choose(ToyModel::place(256 + second));
  CHECK(search.nodes() > 100);
  CHECK(first > 100);
}

TEST_CASE("Nodes with a reward are opened when no others are left") {
  // At 0, action 0 gives a reward, and action 1 does not. Behind each is a line of places.
  const auto world = [](int place, int action) -> Arrow {
    if (place == 0) return action == 0 ? Arrow{1000, 1} : Arrow{1, 0};
    return {place == 50 ? 50 : place + 1, 0};
  };
  ToyModel model(2, world);
  for (const RewardAside aside : {RewardAside::kNone, RewardAside::kNew, RewardAside::kAll}) {
    TreeSettings settings = iw1(5 * 2 * 21);
    settings.reward_aside = aside;
    TreeSearch search(model, settings, 1);
    CHECK(search.choose(ToyModel::place(0)) == 0);
    search.keep(0, ToyModel::place(1000));
    CHECK(search.nodes() == (aside == RewardAside::kNone ? 21 : 1));  // half of the other 20 nodes, or none
  }
  TreeSettings rich = iw1(1000000);
  rich.reward_aside = RewardAside::kNew;
  TreeSearch search(model, rich, 1);
  search.choose(ToyModel::place(0));
  search.keep(0, ToyModel::place(1000));
  CHECK(search.nodes() > 40);  // in the end it was opened
}

namespace {

// Both actions lead from 0 to 1. There, action 0 begins a line with rewards, and action 1 one without.
Arrow two_lines(int place, int action) {
  if (place == 0) return {1, 0};
  if (place == 1) return action == 0 ? Arrow{1000, 1} : Arrow{2, 0};
  return {place + 1, place >= 1000 ? 1.0 : 0.0};
}

// A search at 0, which puts the line with rewards aside, and then the search at 1.
struct Fork {
  ToyModel model{2, two_lines};
  TreeSearch search;
  std::size_t kept = 0;

  explicit Fork(const TreeSettings& settings) : search(model, settings, 1) {
    search.keep(search.choose(ToyModel::place(0)), ToyModel::place(1));
    kept = search.nodes();
    search.choose(ToyModel::place(1));
  }
};

TreeSettings fork_settings(RewardAside aside) {
  TreeSettings settings = iw1(5 * 2 * 21);
  settings.reward_aside = aside;
  return settings;
}

}  // namespace

TEST_CASE("A node that was put aside is opened like others in the next search, or put aside again") {
  ToyModel model(2, two_lines);
  const TreeSettings settings = fork_settings(RewardAside::kNew);
  TreeSearch first(model, settings, 1);
  const int action = first.choose(ToyModel::place(0));
  CHECK(first.value(action) == settings.discount);  // of the first reward only
  // The second reward is new, and put aside.
  CHECK(Fork(settings).search.value(0) == 1 + settings.discount);
  CHECK(Fork(fork_settings(RewardAside::kAll)).search.value(0) == 1);
}

TEST_CASE("A node with a negative reward is put aside only if all with a reward are") {
  ToyModel model(2, [](int place, int action) -> Arrow {
    if (place == 0) return action == 0 ? Arrow{1000, -1} : Arrow{1, 0};
    return {place + 1, 0};
  });
  for (const RewardAside aside : {RewardAside::kNew, RewardAside::kAll}) {
    TreeSearch search(model, fork_settings(aside), 1);
    search.choose(ToyModel::place(0));
    search.keep(0, ToyModel::place(1000));
    CHECK(search.nodes() == (aside == RewardAside::kNew ? 21 : 1));
  }
}

TEST_CASE("A branch of the kept tree that is full gets no frames, and keeps its value") {
  TreeSettings settings = fork_settings(RewardAside::kNew);
  const Fork open(settings);
  REQUIRE(open.search.frames() == 210);
  const std::size_t long_line = open.kept - 2;  // without the root and the node that was put aside
  settings.full_branch = 1;                     // both branches are full
  const Fork none(settings);
  CHECK(none.search.frames() == 0);
  CHECK(none.search.nodes() == none.kept);
  CHECK(none.search.value(0) == 1);
  settings.full_branch = long_line;  // only the line without rewards is full
  Fork one(settings);
  CHECK(one.search.frames() == 210);
  one.search.keep(1, ToyModel::place(2));
  CHECK(one.search.nodes() == long_line);
  one.search.choose(ToyModel::place(2));  // its branches are smaller than it was
  CHECK(one.search.frames() == 210);
  settings.full_branch = long_line + 1;
  Fork neither(settings);
  neither.search.keep(1, ToyModel::place(2));
  CHECK(neither.search.nodes() > long_line);
}

TEST_CASE("Of equal actions, one that ends the episode is not chosen") {
  ToyModel model(3, [](int place, int action) -> Arrow { return {place, 0, action != 1}; });
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    CHECK(TreeSearch(model, settings(2, 3), seed).choose(ToyModel::place(0)) == 1);
}

TEST_CASE("A tree is not kept below an action that ended the episode, and not without a search") {
  ToyModel model(2, end_or_on);
  TreeSettings reusing = settings(4, 2);
  reusing.reuse_tree = true;
  TreeSearch search(model, reusing, 1);
  CHECK(search.value(0) == 0);
  search.keep(0, ToyModel::place(0));
  REQUIRE(search.choose(ToyModel::place(0)) == 0);
  search.keep(0, ToyModel::place(1, true));
  search.choose(ToyModel::place(0));
  CHECK(search.nodes() == 9);
  CHECK(search.frames() == 40);
}
