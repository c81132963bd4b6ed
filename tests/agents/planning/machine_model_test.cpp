#include "agents/planning/machine_model.hpp"

#include <catch2/catch.hpp>

#include "agents/planning/uct.hpp"
#include "environment/saved_state.hpp"
#include "system/resources.hpp"
#include "tests/agents/experiment/samples.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

Settings settings(float sticky = 0) {
  Settings settings = short_episodes(18000).machine;
  settings.sticky = sticky;
  return settings;
}

}  // namespace

TEST_CASE("A search leaves the game as it was, and plays on its own machine") {
  Environment game(beamfall().image, beamfall().game, settings(0.25F)),
      alone(beamfall().image, beamfall().game, settings(0.25F));
  MachineModel model(beamfall(), settings(0.25F), 5);
  Uct uct(model, {.simulations = 20}, 1);
  for (int step = 0; step < 10; ++step) {
    const int action = uct.choose(MachineModel::state_of(game));
    uct.forget();
    REQUIRE(game.act(action) == alone.act(action));
    REQUIRE(game.state_hash() == alone.state_hash());
  }
}

TEST_CASE("On the machine, actions that change nothing are duplicates") {
  Environment game(beamfall().image, beamfall().game, settings());
  for (int i = 0; i < 20; ++i) game.act(1);
  MachineModel model(beamfall(), settings(), 5);
  Uct uct(model, {.simulations = 100}, 1);
  uct.choose(MachineModel::state_of(game));
  CHECK(uct.root()->untried.empty());
  CHECK(uct.root()->children.size() < 18);
  for (const auto& a : uct.root()->children)
    for (const auto& b : uct.root()->children)
      if (a != b && a->reward == b->reward) CHECK(!model.equal(a->state, b->state));
}

TEST_CASE("States that the model takes for equal have the same future") {
  Environment game(beamfall().image, beamfall().game, settings());
  for (int i = 0; i < 20; ++i) game.act(1);
  MachineModel model(beamfall(), settings(), 5);
  const Model::State root = MachineModel::state_of(game);
  std::vector<Model::State> after;
  for (int action = 0; action < model.actions(); ++action) {
    model.enter(root);
    model.act(action);
    after.push_back(model.save());
  }
  int equal = 0;
  for (std::size_t a = 1; a < after.size(); ++a) {
    if (!model.equal(after[0], after[a])) continue;
    ++equal;
    REQUIRE(model.hash(after[0]) == model.hash(after[a]));
    Environment one(beamfall().image, beamfall().game, settings()),
        other(beamfall().image, beamfall().game, settings());
    one.restore(*static_cast<const Environment::Saved*>(after[0].get()));
    other.restore(*static_cast<const Environment::Saved*>(after[a].get()));
    Random random(a);
    for (int step = 0; step < 100; ++step) {
      const int action = static_cast<int>(random.below(18));
      REQUIRE(one.act(action) == other.act(action));
      REQUIRE(one.state_hash() == other.state_hash());
    }
  }
  CHECK(equal > 0);
  MachineModel sticky(beamfall(), settings(0.25F), 5);
  for (std::size_t a = 1; a < after.size(); ++a) CHECK(!sticky.equal(after[0], after[a]));
}

TEST_CASE("The game goes where the search saw it go, so that the subtree is kept") {
  Environment game(beamfall().image, beamfall().game, settings());
  MachineModel model(beamfall(), settings(), 5);
  Uct uct(model, {.simulations = 50}, 1);
  for (int step = 0; step < 10; ++step) {
    const int action = uct.choose(MachineModel::state_of(game));
    game.act(action);
    uct.keep(action, MachineModel::state_of(game));
    REQUIRE(uct.root() != nullptr);
  }
}

TEST_CASE("A model tries the actions that it was given, and counts their frames") {
  Environment game(beamfall().image, beamfall().game, settings());
  const Model::State root = MachineModel::state_of(game);
  MachineModel model(beamfall(), settings(), 5, {4, 3});
  REQUIRE(model.actions() == 2);
  for (const int number : {0, 1}) {
    game.restore(*static_cast<const Environment::Saved*>(root.get()));
    game.act(number == 0 ? 4 : 3);
    model.enter(root);
    model.act(number);
    CHECK(model.equal(model.save(), MachineModel::state_of(game)));
  }
  CHECK(model.frames() == 2 * 5);
}

TEST_CASE("With sticky actions, a model that is read from a checkpoint draws the same chances") {
  Environment game(beamfall().image, beamfall().game, settings());
  const Model::State root = MachineModel::state_of(game);
  MachineModel model(beamfall(), settings(0.25F), 5), other(beamfall(), settings(0.25F), 6);
  const auto plays = [&](MachineModel& of) {
    of.enter(root);
    for (int step = 0; step < 100; ++step) of.act(3 + step % 2);
    return of.save();
  };
  StateWriter out;
  model.write(out);
  const Model::State first = plays(model);
  CHECK(!model.equal(plays(other), first));
  StateReader in(out.bytes());
  other.read(in);
  CHECK(in.at_end());
  CHECK(model.equal(plays(other), first));
  StateReader invalid(std::string_view(out.bytes()).substr(1));
  CHECK_THROWS_AS(other.read(invalid), InvalidInput);
  StateWriter none;
  MachineModel(beamfall(), settings(), 5).write(none);
  CHECK(none.bytes().empty());
}

#if !defined(__SANITIZE_ADDRESS__)  // the sanitizer keeps released memory
TEST_CASE("A tree of 26,600 states takes less than 128 MiB") {
  Environment game(beamfall().image, beamfall().game, settings());
  MachineModel model(beamfall(), settings(), 5);
  std::vector<Model::State> states;
  const std::uint64_t before = resident_memory();
  for (int i = 0; i < 26600; ++i) {
    if (i % 100 == 0) model.enter(MachineModel::state_of(game));
    model.act(i % 18);
    states.push_back(model.save());
  }
  CHECK(resident_memory() - before < std::uint64_t{128} << 20);
}
#endif
