// Actions that press or move a switch of the console (docs/spec/environment.md, 1).
#include <catch2/catch.hpp>
#include <vector>

#include "environment/vector/slot.hpp"
#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

using test::at;
using test::plain;
using test::steered;

constexpr int kSwchb = 0x82, kSelects = 0x85, kResets = 0x86;
constexpr int kNoop = 0;

// What the program reads of SWCHB after this action.
int swchb_after(Environment& environment, int action) {
  environment.act(action);
  environment.act(kNoop);  // the program may have read SWCHB before
  return at(environment, kSwchb);
}

TEST_CASE("RESET and SELECT are held for the frames of their act") {
  Settings settings = plain();
  settings.frame_skip = 4;
  Environment environment = steered(settings);
  const int resets = at(environment, kResets), selects = at(environment, kSelects);
  environment.act(kResetAction);
  environment.act(kNoop);
  CHECK(at(environment, kResets) == resets + 4);
  CHECK(at(environment, kSelects) == selects);
  environment.act(kSelectAction);
  environment.act(kSelectAction);
  environment.act(kNoop);
  CHECK(at(environment, kResets) == resets + 4);
  CHECK(at(environment, kSelects) == selects + 8);
}

TEST_CASE("The reference's number of RESET presses nothing") {
  Environment environment = steered();
  const int resets = at(environment, kResets);
  for (int n = 0; n < 5; ++n) environment.act(kReferenceReset);
  CHECK(at(environment, kResets) == resets);
}

TEST_CASE("Other switches stay where an action has moved them, until the next reset") {
  Environment environment = steered();
  environment.set_difficulty(2);
  const int rest = kSwitchesAtRest | kSwitchRightA;
  CHECK(swchb_after(environment, kNoop) == rest);
  CHECK(swchb_after(environment, kLeftAAction) == (rest | kSwitchLeftA));
  CHECK(swchb_after(environment, kLeftAAction) == (rest | kSwitchLeftA));
  CHECK(swchb_after(environment, kRightBAction) == (kSwitchesAtRest | kSwitchLeftA));
  CHECK(swchb_after(environment, kBlackAndWhiteAction) == ((kSwitchesAtRest | kSwitchLeftA) ^ kSwitchColor));
  CHECK(swchb_after(environment, kLeftBAction) == (kSwitchesAtRest ^ kSwitchColor));
  CHECK(swchb_after(environment, kColorAction) == kSwitchesAtRest);
  CHECK(swchb_after(environment, kRightAAction) == rest);
  CHECK(environment.difficulty() == 2);
  environment.act(kBlackAndWhiteAction);
  environment.act(kRightBAction);
  environment.set_difficulty(1);
  CHECK(swchb_after(environment, kNoop) == ((kSwitchesAtRest | kSwitchLeftA) ^ kSwitchColor));
  environment.reset_game();
  CHECK(swchb_after(environment, kNoop) == (kSwitchesAtRest | kSwitchLeftA));
}

TEST_CASE("Positions of switches belong to states, and to their hashes") {
  Environment environment = steered();
  environment.act(kBlackAndWhiteAction);
  environment.act(kNoop);
  const auto saved = environment.save();
  const auto hash = environment.state_hash();
  environment.act(kColorAction);
  environment.act(kNoop);
  CHECK(environment.state_hash() != hash);
  environment.restore(*saved);
  CHECK(environment.state_hash() == hash);
  CHECK(swchb_after(environment, kNoop) == (kSwitchesAtRest ^ kSwitchColor));
}

TEST_CASE("A sticky frame repeats RESET as any other action") {
  Settings settings = plain();
  settings.sticky = 1;
  Environment environment = steered(settings);
  const int resets = at(environment, kResets);
  for (int n = 0; n < 10; ++n) environment.act(kResetAction);
  CHECK(at(environment, kResets) == resets);
  settings.sticky = 0.5F;
  environment = steered(settings);
  for (int n = 0; n < 100; ++n) environment.act(n % 2 == 0 ? kResetAction : kNoop);
  const int pressed = at(environment, kResets) - resets;
  CHECK(pressed > 20);
  CHECK(pressed < 80);
}

TEST_CASE("Player B acts while player A presses a switch; A's joystick and paddle rest") {
  Environment environment = steered();
  environment.act(kSelectAction, 18 + 2);
  environment.act(kSelectAction, 18 + 2);
  CHECK(environment.ram()[1] == 0xFE);  // SWCHA: B's stick is up
}

TEST_CASE("Each action set has its numbers") {
  const auto game = test::game();
  CHECK(actions_of(ActionSet::kFull, *game).size() == kActions);
  const std::vector<int>& console = actions_of(ActionSet::kConsole, *game);
  REQUIRE(console.size() == kConsoleActions);
  for (int action = 0; action < kConsoleActions; ++action)
    CHECK(console[static_cast<std::size_t>(action)] == action);
}

}  // namespace
}  // namespace racebeam
