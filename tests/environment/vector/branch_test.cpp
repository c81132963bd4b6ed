#include "environment/vector/branch.hpp"

#include <catch2/catch.hpp>

#include "tests/environment/steered.hpp"
#include "tests/support/observation.hpp"

namespace racebeam {
namespace {

using test::observe;
using test::plain;
using test::steered;
using Sequence = std::vector<Act>;

Settings sticky() {
  Settings settings = plain();
  settings.sticky = 0.5F;
  settings.frame_skip = 2;
  settings.max_episode_frames = 20;
  return settings;
}

// Plays the branch by hand.
BranchEnd by_hand(const Environment::Saved& start, const Environment::Saved& root, const Sequence& sequence) {
  Environment environment = steered(sticky());
  environment.restore(start);
  environment.restore(root);
  BranchEnd end;
  for (const Act& act : sequence) {
    if (environment.game_over()) break;
    const int before = environment.frame_number();
    end.reward += environment.act(act.a);
    end.frames += environment.frame_number() - before;
    ++end.acts;
  }
  end.truncated = environment.truncated();
  return end;
}

TEST_CASE("Branches lead where the same acts lead by themselves, and disturb nothing") {
  Environment environment = steered(sticky());
  for (int act = 0; act < 2; ++act) environment.act(3);
  const auto root = environment.save();
  environment.act(4);
  const auto start = environment.save(true);
  const auto before = observe(environment);

  const std::vector<Sequence> sequences = {
      Sequence(3, {.a = 1}), {}, Sequence(100, {.a = 5}), Sequence(3, {.a = 1})};
  std::vector<BranchEnd> ends(sequences.size());
  branch(environment, *root, sequences, ends);
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    const BranchEnd expected = by_hand(*start, *root, sequences[i]);
    CHECK(ends[i].reward == expected.reward);
    CHECK(ends[i].acts == expected.acts);
    CHECK(ends[i].frames == expected.frames);
    CHECK(ends[i].truncated == expected.truncated);
  }
  CHECK(ends[1].acts == 0);
  CHECK(ends[2].acts == 8);
  CHECK(ends[2].truncated);
  CHECK(observe(environment) == before);
  CHECK(*environment.save(true)->random == *start->random);
  CHECK(environment.same_state(environment));
}

TEST_CASE("Rewards of a branch are summed") {
  Environment environment = steered();
  const auto root = environment.save();
  environment.set_ram(test::kScore, 7);
  const auto scored = environment.save();
  std::vector<BranchEnd> ends(1);
  branch(environment, *scored, std::vector<Sequence>{Sequence(2)}, ends);
  CHECK(ends[0].reward == 7);
  branch(environment, *root, std::vector<Sequence>{Sequence(2)}, ends);
  CHECK(ends[0].reward == 0);
}

TEST_CASE("A branch that can't be played leaves the environment as it was") {
  Environment environment = steered(sticky());
  const auto root = environment.save();
  environment.act(2);
  const auto before = observe(environment);
  std::vector<BranchEnd> ends(1);
  CHECK_THROWS_AS(branch(environment, *root, std::vector<Sequence>{{{.a = 0}, {.a = 77}}}, ends),
                  std::invalid_argument);
  CHECK(observe(environment) == before);
  CHECK_THROWS_WITH(branch(environment, *root, std::vector<Sequence>(2), ends),
                    "there is room for 1 results of 2 branches");
}

}  // namespace
}  // namespace racebeam
