#include "agents/planning/uct.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "tests/agents/planning/toy_model.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

UctSettings settings(int simulations, int depth) {
  return {.simulations = simulations,
          .depth = depth,
          .exploration = 5,
          .discount = 0.9,
          .reward_scale = RewardScale::kNone};
}

std::string describe(const Uct::Node& node) {
  std::string text =
      std::to_string(node.action) + ":" + std::to_string(node.visits) + ":" + std::to_string(node.mean) + "(";
  for (const auto& child : node.children) text += describe(*child);
  return text + ")";
}

}  // namespace

TEST_CASE("UCT looks behind a trap, and counts the visits of its root") {
  ToyModel model(2, trap);
  Uct uct(model, settings(200, 5), 1);
  CHECK(uct.choose(ToyModel::place(0)) == 1);
  CHECK(uct.root()->visits == 200);
  std::int64_t below = 0;
  for (const auto& child : uct.root()->children) below += child->visits;
  CHECK(below == 199);  // the first simulation played from the root itself
}

// One action, so that nothing is random: rewards 1, 2, 4, then the end. Depth 3.
TEST_CASE("The values of a line are those computed by hand") {
  ToyModel model(1, [](int place, int) -> Arrow { return {place + 1, double(1 << place), place == 2}; });
  Uct uct(model, settings(2, 3), 1);
  CHECK(uct.choose(ToyModel::place(0)) == 0);
  const Uct::Node& child = *uct.root()->children.at(0);
  const double below = 2 + 0.9 * 4;  // what a rollout from the child returns
  CHECK(child.visits == 1);
  CHECK(child.mean == Approx(1 + 0.9 * below));
  // The root itself has no reward: both returns are discounted once on the way into it.
  CHECK(uct.root()->mean == Approx(0.9 * (1 + 0.9 * below)));
  CHECK(uct.frames() == 5 * (3 + 3));
}

// The visits of actions with these rewards after so many steps by UCB1, the first of which try each action.
std::vector<std::int64_t> visits_by_ucb1(const std::vector<double>& rewards, int steps, double exploration) {
  std::vector<std::int64_t> visits(rewards.size(), 1);
  for (int step = static_cast<int>(rewards.size()); step < steps; ++step) {
    std::size_t best = 0;
    double highest = -1e9;
    for (std::size_t i = 0; i < rewards.size(); ++i) {
      // The root was also visited by the first simulation, which plays from there.
      const double bound = rewards[i] + exploration * std::sqrt(std::log(step + 1.0) / double(visits[i]));
      if (bound > highest) highest = bound, best = i;
    }
    ++visits[best];
  }
  return visits;
}

TEST_CASE("UCT visits actions as UCB1 says") {
  const std::vector<double> rewards = {0.5, 3, 2.25};
  ToyModel model(3, [&](int, int action) -> Arrow {
    return {1 + action, rewards[static_cast<std::size_t>(action)]};
  });
  for (const double exploration : {0.1, 1.0, 5.0}) {
    UctSettings chosen = settings(100, 1);
    chosen.exploration = exploration;
    Uct uct(model, chosen, 1);
    CHECK(uct.choose(ToyModel::place(0)) == 1);
    const auto expected = visits_by_ucb1(rewards, 99, exploration);
    for (const auto& child : uct.root()->children) {
      INFO("exploration " << exploration << ", action " << child->action);
      CHECK(child->visits == expected[static_cast<std::size_t>(child->action)]);
    }
  }
}

TEST_CASE("Of actions that were visited as often, the better one is chosen") {
  ToyModel model(2, [](int, int action) -> Arrow { return {1 + action, double(action)}; });
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    CHECK(Uct(model, settings(3, 1), seed).choose(ToyModel::place(0)) == 1);
}

TEST_CASE("Where the episode is over, UCT chooses any action and runs no frame") {
  ToyModel model(3, [](int, int) -> Arrow { return {1, 1}; });
  Uct uct(model, settings(50, 5), 1);
  uct.choose(ToyModel::place(0));
  const std::int64_t before = model.frames();
  std::set<int> chosen;
  for (int i = 0; i < 50; ++i) {
    uct.forget();
    chosen.insert(uct.choose(ToyModel::place(0, true)));
  }
  CHECK(chosen == std::set{0, 1, 2});
  CHECK(uct.frames() == 0);
  CHECK(model.frames() == before);
}

TEST_CASE("Depth counts from the present root") {
  ToyModel model(1, [](int place, int) -> Arrow { return {place + 1, 1}; });
  Uct uct(model, settings(1, 60), 1);
  uct.choose(ToyModel::place(0));
  CHECK(uct.frames() == 300 + 300);  // a rollout from the root, and one through a child, which it needs
}

TEST_CASE("Siblings in the same state are one, if they are merged") {
  const auto world = [](int place, int action) -> Arrow { return {3 * place + action % 3 + 1, 0}; };
  for (const bool merge : {true, false}) {
    ToyModel model(18, world);
    UctSettings chosen = settings(100, 4);
    chosen.merge_duplicates = merge;
    Uct uct(model, chosen, 1);
    uct.choose(ToyModel::place(0));
    CHECK(uct.root()->children.size() == (merge ? 3 : 18));
    CHECK(uct.root()->untried.empty());
  }
}

TEST_CASE("Siblings in the same state with different rewards are two") {
  ToyModel model(2, [](int, int action) -> Arrow { return {1, double(action)}; });
  Uct uct(model, settings(50, 1), 1);
  CHECK(uct.choose(ToyModel::place(0)) == 1);
  CHECK(uct.root()->children.size() == 2);
}

TEST_CASE("A kept subtree is the same tree, and its visits count") {
  ToyModel model(2, [](int place, int action) -> Arrow { return {2 * place + action + 1, double(action)}; });
  Uct uct(model, settings(300, 10), 1);
  const int action = uct.choose(ToyModel::place(0));
  REQUIRE(action == 1);
  const Uct::Node* old_child = nullptr;
  for (const auto& child : uct.root()->children)
    if (child->action == action) old_child = child.get();
  const std::string before = describe(*old_child);
  uct.keep(action, ToyModel::place(2));
  CHECK(describe(*uct.root()) == before);
  CHECK(uct.root()->parent == nullptr);
  const std::int64_t visits = uct.root()->visits;
  const std::int64_t frames = model.frames();
  uct.choose(ToyModel::place(2));
  CHECK(uct.root()->visits == 300);
  CHECK(model.frames() - frames <= (300 - visits) * 5 * 10);
}

TEST_CASE("A subtree is dropped when the world went elsewhere") {
  ToyModel model(2, [](int place, int action) -> Arrow { return {2 * place + action + 1, 0}; });
  Uct uct(model, settings(50, 5), 1);
  const int action = uct.choose(ToyModel::place(0));
  uct.keep(action, ToyModel::place(99));
  CHECK(uct.root() == nullptr);
  uct.choose(ToyModel::place(99));
  CHECK(uct.root()->visits == 50);
}

TEST_CASE("An end is never passed") {
  ToyModel model(2, end_or_on);
  UctSettings patient = settings(400, 30);
  CHECK(Uct(model, patient, 1).choose(ToyModel::place(0)) == 1);
  patient.depth = 3;
  CHECK(Uct(model, patient, 1).choose(ToyModel::place(0)) == 0);
}

TEST_CASE("The same seed searches the same") {
  ToyModel model(4, [](int place, int action) -> Arrow {
    return {4 * place % 1000 + action, double(place % 7 == action)};
  });
  Uct one(model, settings(200, 10), 5), other(model, settings(200, 10), 5),
      third(model, settings(200, 10), 6);
  one.choose(ToyModel::place(0));
  other.choose(ToyModel::place(0));
  third.choose(ToyModel::place(0));
  CHECK(describe(*one.root()) == describe(*other.root()));
  CHECK(describe(*one.root()) != describe(*third.root()));
}

TEST_CASE("Siblings in the same place are two if only one of them ends the episode") {
  ToyModel model(2, [](int, int action) -> Arrow { return {1, 0, action == 0}; });
  Uct uct(model, settings(50, 1), 1);
  uct.choose(ToyModel::place(0));
  CHECK(uct.root()->children.size() == 2);
}

TEST_CASE("A tree is not kept below an action that ended the episode, nor without a search") {
  ToyModel model(2, end_or_on);
  Uct uct(model, settings(50, 1), 1);
  uct.keep(0, ToyModel::place(0));
  CHECK(uct.root() == nullptr);
  REQUIRE(uct.choose(ToyModel::place(0)) == 0);
  uct.keep(0, ToyModel::place(1, true));
  CHECK(uct.root() == nullptr);
}
