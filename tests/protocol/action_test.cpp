#include "protocol/line/action.hpp"

#include <catch2/catch.hpp>

#include "games/game/actions.hpp"
#include "protocol/description/tables.hpp"
#include "protocol/request_error.hpp"
#include "system/invalid_input.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;

namespace {

const AllowedActions kAll{"pong", 0x3FFFF, 0x3FFFF}, kSome{"pong", 0b1011, 0b1011},
    kConsole{"pong", 0x3FFFFFF, 0x3FFFF};

// A keyboard, and a booster grip.
AllowedActions with_controllers() {
  AllowedActions actions = kConsole;
  for (const int key : actions_with(Controller::kKeyboard))
    actions.allowed.set(static_cast<std::size_t>(key));
  for (const int action : actions_with(Controller::kBooster))
    actions.allowed_b.set(static_cast<std::size_t>(action));
  return actions;
}

std::string refusal(const std::string& word, const AllowedActions& actions = kAll) {
  try {
    parse_action(word, actions);
  } catch (const RequestError& refused) {
    return std::string(name_of(refused.code())) + ": " + refused.what();
  } catch (const InvalidInput& refused) {
    return std::string("bad-value: ") + refused.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("Actions are names or numbers") {
  CHECK(parse_action("NOOP", kAll).act.a == 0);
  CHECK(parse_action("17", kAll).act.a == 17);
  CHECK(parse_action("DOWNLEFTFIRE", kAll).act.a == 17);
  CHECK(parse_action("3", kAll).act.b == 18);
}

TEST_CASE("The names are those of the protocol's description") {
  REQUIRE(description::kActions.size() == kConsoleActions);
  for (int action = 0; action < kConsoleActions; ++action)
    CHECK(description::kActions[static_cast<std::size_t>(action)] == action_name(action));
}

TEST_CASE("Names of actions may have small letters") {
  CHECK(parse_action("downleftfire", kAll).act.a == 17);
  CHECK(parse_action("Fire/left@0.5*3", kAll).act.b == 18 + 4);
  CHECK_THAT(refusal("up", kSome), Contains("'up' is not in the action set"));
}

TEST_CASE("The switches of the console are actions of player A, where they were asked for") {
  CHECK(parse_action("RESET", kConsole).act.a == 18);
  CHECK(parse_action("select/UP*3", kConsole).act.a == 19);
  CHECK(parse_action("LEFT_A", kConsole).act.a == 20);
  CHECK(parse_action("25", kConsole).act.a == 25);
  CHECK_THAT(refusal("RESET"), Contains("'RESET' needs a game that was loaded with action_set=console"));
  CHECK_THAT(refusal("NOOP/RESET", kConsole),
             Contains("'RESET' is an action of player A only; pong takes 0=NOOP"));
  CHECK_THAT(refusal("38", kConsole), Contains("'38' is not an action; pong takes 0=NOOP") &&
                                          Contains("17=DOWNLEFTFIRE 18=RESET 19=SELECT 20=LEFT_A"));
}

TEST_CASE("Keys and more buttons are actions where their controller is connected, of its player") {
  const AllowedActions actions = with_controllers();
  CHECK(parse_action("KEY7", actions).act.a == 32);
  CHECK(parse_action("keyhash*3", actions).act.a == 37);
  CHECK(parse_action("KEY1/UPFIRE+TRIGGER+BOOSTER", actions).act.b == 18 + 160 + 10);
  CHECK(parse_action("NOOP/96", actions).act.b == 18 + 96);
  CHECK_THAT(refusal("KEY7"), Contains("'KEY7' needs a game with a keyboard"));
  CHECK_THAT(refusal("99"), Contains("'99' is not an action; pong takes 0=NOOP"));
  CHECK_THAT(refusal("NOOP/KEY7", actions), Contains("'KEY7' needs a game with a keyboard"));
  CHECK_THAT(refusal("UP+C", actions), Contains("'UP+C' needs a controller with that button"));
  CHECK_THAT(refusal("UP+TRIGGER", actions), Contains("'UP+TRIGGER' needs a controller with that button"));
  CHECK_THAT(refusal("38", actions), Contains("'38' is not an action") && Contains("37=KEYHASH"));
}

TEST_CASE("A place on the screen is written X,Y") {
  CHECK(parse_action("FIRE@80,100", kAll).act.strength_a == 80 + 256 * 100);
  CHECK(parse_action("NOOP/FIRE@159,255*2", kAll).act.strength_b == 159 + 256 * 255);
  for (const std::string word :
       {"FIRE@160,1", "FIRE@0,0", "FIRE@0,256", "FIRE@,1", "FIRE@1,", "FIRE@1,2,3"}) {
    INFO(word);
    CHECK_THAT(refusal(word), Contains("bad-"));
  }
}

TEST_CASE("Each place on the screen, number of times and letter is taken up to its limit") {
  CHECK(parse_action("FIRE@0,1", kAll).act.strength_a == 256);
  CHECK(parse_action("FIRE@0,255", kAll).act.strength_a == 256 * 255);
  CHECK(parse_action("FIRE@159,1", kAll).act.strength_a == 159 + 256);
  CHECK(parse_action("FIRE*1", kAll).times == 1);
  CHECK(parse_action("FIRE*1000000000", kAll).times == 1'000'000'000);
  CHECK(parse_action("left_a", kConsole).act.a == 20);
}

TEST_CASE("An action that was misspelt is suggested from the player's set") {
  CHECK_THAT(refusal("fier"), Contains("did you mean FIRE?"));
  CHECK_THAT(refusal("NOOP/fier"), Contains("did you mean FIRE?"));
  CHECK_THAT(refusal("JUMP"), !Contains("did you mean"));
}

TEST_CASE("Player B, strengths and repetition") {
  const Action action = parse_action("RIGHT@0.5/UPFIRE@0.25*30", kAll);
  CHECK(action.act.a == 3);
  CHECK(action.act.strength_a == 0.5F);
  CHECK(action.act.b == 18 + 10);
  CHECK(action.act.strength_b == 0.25F);
  CHECK(action.times == 30);
  CHECK(parse_action("RIGHT/LEFT", kAll).act.strength_b == 1);
  CHECK(parse_action("RIGHT", kAll).act.strength_b == 0);
  CHECK(parse_action("RIGHT@1.5", kAll).act.strength_a == 1.5F);  // continuous actions may have such a radius
  CHECK(parse_action("LEFT@-0.5", kAll).act.strength_a == -0.5F);
}

TEST_CASE("An unknown action is refused with the list of actions") {
  for (const std::string word : {"18", "-1", "99999999999", "", "fier", "reset", "FIRE ", "1x", "RESET", "40",
                                 "/", "1/", "/1", "1/18"}) {
    INFO(word);
    CHECK_THAT(refusal(word), Contains("bad-action: ") && Contains("pong takes 0=NOOP 1=FIRE"));
  }
  for (const std::string word :
       {"1@", "1@x", "1@inf", "1@1e39", "1@nan", "1*", "1*0", "1*x", "1*1000000001"}) {
    INFO(word);
    CHECK_THAT(refusal(word), Contains("bad-value: "));
  }
}

TEST_CASE("With a smaller set the others are refused, the numbers are the same") {
  CHECK(parse_action("RIGHT", kSome).act.a == 3);
  CHECK_THAT(refusal("UP", kSome),
             Contains("'UP' is not in the action set that was loaded; pong takes 0=NOOP 1=FIRE 3=RIGHT"));
  CHECK_THAT(refusal("0/2", kSome), Contains("bad-action"));
}
