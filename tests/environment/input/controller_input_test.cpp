#include <array>
#include <catch2/catch.hpp>

#include "environment/input/controller_input.hpp"

namespace racebeam {
namespace {

// The pressed controls, and the final positions of the paddles.
struct Player {
  ControllerInput hands;
  Inputs inputs{};
  PaddleValues paddles = hands.middle();
  ConsoleSwitches switches{};

  void press(int a, float strength_a = 1.0F, int b = 18, float strength_b = 0.0F, int difficulty = 0) {
    switches.set_difficulty(difficulty);
    switches.act(a);
    hands.press(inputs, {{a, strength_a}, {b, strength_b}}, switches, paddles);
  }
  std::int32_t paddle_after(int a, float strength = 1.0F) {
    press(a, strength);
    CHECK(inputs.paddle[0] == paddles[0]);
    return paddles[0];
  }
};

Player with(Controller left, Controller right = Controller::kJoystick, PaddleLimits limits = {}) {
  Properties properties;
  properties.left = left;
  properties.right = right;
  return {ControllerInput(properties, limits)};
}

Player with_joysticks() { return with(Controller::kJoystick); }
Player with_paddles() { return with(Controller::kPaddles); }

constexpr int kRight = 3, kLeft = 4;

TEST_CASE("Each action presses the stick as its name says") {
  constexpr std::uint8_t kUp = kStickUp, kDown = kStickDown, kL = kStickLeft, kR = kStickRight,
                         kFire = kStickFire;
  constexpr std::uint8_t kExpected[18] = {0,
                                          kFire,
                                          kUp,
                                          kR,
                                          kL,
                                          kDown,
                                          kUp | kR,
                                          kUp | kL,
                                          kDown | kR,
                                          kDown | kL,
                                          kUp | kFire,
                                          kR | kFire,
                                          kL | kFire,
                                          kDown | kFire,
                                          kUp | kR | kFire,
                                          kUp | kL | kFire,
                                          kDown | kR | kFire,
                                          kDown | kL | kFire};
  Player player = with_joysticks();
  for (int a = 0; a < 18; ++a) {
    player.press(a);
    CHECK(player.inputs.joystick == std::array<std::uint8_t, 2>{kExpected[a], 0});
    player.press(0, 1.0F, 18 + a);
    CHECK(player.inputs.joystick == std::array<std::uint8_t, 2>{0, kExpected[a]});
  }
  CHECK(player.inputs.paddle_fire == 0);
}

TEST_CASE("Every frame starts with everything released") {
  Player player = with_joysticks();
  ControllerInput::press_select(player.inputs, {});
  player.press(17, 1.0F, 35);
  player.press(kResetAction);
  CHECK(player.inputs.joystick == std::array<std::uint8_t, 2>{});
  CHECK(player.inputs.switches == (kSwitchesAtRest & ~kSwitchReset));
  player.press(0);
  CHECK(player.inputs.switches == kSwitchesAtRest);
}

TEST_CASE("A number that is not an action presses nothing") {
  Player player = with_paddles();
  for (const int odd : {36, 40, 41, 99, -1}) {
    player.press(odd, 1.0F, odd, 1.0F);
    CHECK(player.inputs.paddle_fire == 0);
    CHECK(player.paddles == PaddleValues{408823, 408823});
    CHECK(player.inputs.switches == kSwitchesAtRest);
  }
}

TEST_CASE("The difficulty sets the switches, also while SELECT is held") {
  Player player = with_joysticks();
  for (int difficulty = 0; difficulty < 4; ++difficulty) {
    const int bits = (difficulty & 1 ? kSwitchLeftA : 0) | (difficulty & 2 ? kSwitchRightA : 0);
    player.press(0, 1.0F, 18, 0.0F, difficulty);
    CHECK(player.inputs.switches == (kSwitchesAtRest | bits));
    player.switches.set_difficulty(difficulty);
    ControllerInput::press_select(player.inputs, player.switches);
    CHECK(player.inputs.switches == ((kSwitchesAtRest & ~kSwitchSelect) | bits));
  }
}

// docs/spec/environment.md, 17: "Paddle"
TEST_CASE("A paddle turns as in the reference, and stops at its ends") {
  Player player = with_paddles();
  CHECK(player.paddles[0] == 408823);
  CHECK(player.paddle_after(kRight) == 385823);
  CHECK(player.paddle_after(kLeft) == 408823);
  CHECK(player.paddle_after(kLeft, 0.5F) == 420323);
  CHECK(player.paddle_after(kLeft, -0.3333F) == 427988);
  for (int i = 0; i < 39; ++i) player.press(kRight);
  CHECK(player.paddle_after(kRight) == 27450);
  for (int i = 0; i < 59; ++i) player.press(kLeft);
  CHECK(player.paddle_after(kLeft) == 790196);
  CHECK(player.hands.middle() == PaddleValues{408823, 408823});
}

// docs/spec/console.md, "More cases", 4
TEST_CASE("A strength is widened to double before the product") {
  Player player = with_paddles();
  CHECK(player.paddle_after(kRight, 0.7F) == 392724);
  CHECK(player.paddle_after(kLeft, 0.35F) == 400773);
}

// 408823 + 23000 * 93351 is the last sum that 32 bits hold.
TEST_CASE("A paddle that is turned beyond 32 bits to the left ends on the right, as in ALE") {
  constexpr float kFarthest = 93351, kProduct = 93368.8F;  // 23000 * kProduct is above 2^31
  CHECK(with_paddles().paddle_after(kLeft, kFarthest) == 790196);
  for (const float strength : {kFarthest + 1, kProduct, 1e9F, -1e9F, 3.4e38F})
    CHECK(with_paddles().paddle_after(kLeft, strength) == 27450);
  for (const float strength : {kFarthest, kFarthest + 1, kProduct, 1e9F, -1e9F, 3.4e38F})
    CHECK(with_paddles().paddle_after(kRight, strength) == 27450);
  CHECK(with_paddles().paddle_after(0, 3.4e38F) == 408823);
}

TEST_CASE("Paddle 1 is player B's") {
  Player player = with_paddles();
  player.press(1, 1.0F, 18 + kLeft, 0.5F);
  CHECK(player.paddles == PaddleValues{408823, 420323});
  CHECK(player.inputs.paddle[1] == 420323);
  CHECK(player.inputs.paddle_fire == 1);
  player.press(11, 1.0F, 18 + 12, 1.0F);  // RIGHTFIRE, LEFTFIRE
  CHECK(player.paddles == PaddleValues{385823, 443323});
  CHECK(player.inputs.paddle_fire == 3);
  player.press(kResetAction, 1.0F, 19);
  CHECK(player.inputs.paddle_fire == 2);
  CHECK(player.inputs.switches == (kSwitchesAtRest & ~kSwitchReset));
}

TEST_CASE("With paddles, up and down do nothing and the sticks are not driven") {
  Player player = with_paddles();
  for (const int a : {2, 5, 10, 13}) player.press(a, 1.0F, 18 + a, 1.0F);
  CHECK(player.paddles == PaddleValues{408823, 408823});
  CHECK(player.inputs.joystick == std::array<std::uint8_t, 2>{});
  CHECK(player.inputs.paddle_fire == 3);
  CHECK(player.paddle_after(6) == 385823);  // UPRIGHT
}

TEST_CASE("SELECT leaves the paddles where they are") {
  Player player = with_paddles();
  player.press(kRight, 1.0F, 19, 0.0F);
  ControllerInput::press_select(player.inputs, {});
  CHECK(player.inputs.paddle[0] == 385823);
  CHECK(player.inputs.paddle_fire == 0);
}

TEST_CASE("A paddle never leaves its limits, however strong the turn") {
  Player player = with(Controller::kPaddles, Controller::kJoystick, {100, 1000});
  CHECK(player.paddles[0] == 550);
  CHECK(player.paddle_after(kLeft, 9.0e4F) == 1000);
  CHECK(player.paddle_after(kRight, -3.0e38F) == 100);
}

TEST_CASE("A key is held on the keyboard of its player, and nothing else presses one") {
  Player player = with(Controller::kKeyboard, Controller::kKeyboard);
  for (int key = 0; key < kKeys; ++key) {
    player.press(kFirstKey + key);
    CHECK(player.inputs.paddle[0] == 1 << key);
    CHECK(player.inputs.paddle[2] == 0);
    player.press(0, 1.0F, 18 + kFirstKey + key);
    CHECK(player.inputs.paddle[0] == 0);
    CHECK(player.inputs.paddle[2] == 1 << key);
  }
  for (const int other : {0, 1, 17, 18, 25, 38, 64}) {
    player.press(other);
    CHECK(player.inputs.paddle[0] == 0);
  }
}

TEST_CASE("More buttons are pressed on a pad or a grip only") {
  for (const Controller controller : {Controller::kGenesis, Controller::kBooster}) {
    Player player = with(controller, controller);
    for (int stick = 0; stick < 18; ++stick) {
      player.press(stick);
      const std::uint8_t plain = player.inputs.joystick[0];
      player.press(kWithC + stick, 1.0F, 18 + kWithTrigger + stick);
      const auto second = static_cast<std::uint8_t>(plain | kStickSecond);
      CHECK(player.inputs.joystick == std::array<std::uint8_t, 2>{second, second});
      player.press(kWithBooster + stick, 1.0F, 18 + kWithBoth + stick);
      CHECK(player.inputs.joystick[0] == (plain | kStickThird));
      CHECK(player.inputs.joystick[1] == (plain | kStickSecond | kStickThird));
    }
  }
  Player player = with_joysticks();
  player.press(kWithC + 2, 1.0F, 18 + kWithC + 2);
  CHECK(player.inputs.joystick == std::array<std::uint8_t, 2>{});
}

TEST_CASE("A wheel turns by one place in each frame, in both directions and without an end") {
  Player player = with(Controller::kDriving, Controller::kDriving);
  for (std::int32_t frame = 0; frame < 70000; ++frame) {
    player.press(kRight, 5.0F, 18 + kLeft, 1.0F);
    const Axis right = Axis::of(player.inputs.paddle[0]), left = Axis::of(player.inputs.paddle[2]);
    REQUIRE(right.place == frame % Axis::kPlaces);
    REQUIRE((left.place + frame) % Axis::kPlaces == 0);
    REQUIRE(right.moved == 1);
    REQUIRE(left.moved == -1);
  }
  const std::int32_t place = Axis::of(player.inputs.paddle[0]).place;
  player.press(kRight, 0.0F);
  CHECK(Axis::of(player.inputs.paddle[0]).moved == 0);
  CHECK(Axis::of(player.inputs.paddle[0]).place == (place + 1) % Axis::kPlaces);
}

TEST_CASE("A ball and a mouse move by the strength of their direction, up to 127 places in each frame") {
  for (const Controller controller :
       {Controller::kTrackball, Controller::kAtariMouse, Controller::kAmigaMouse}) {
    Player player = with(controller);
    constexpr int kDownRightFire = 16, kUpLeft = 7;
    player.press(kDownRightFire, 12.0F);
    CHECK(Axis::of(player.inputs.paddle[0]).moved == 12);
    CHECK(Axis::of(player.inputs.paddle[1]).moved == 12);
    CHECK((player.inputs.joystick[0] & kStickFire) != 0);
    player.press(kUpLeft, -1000.0F);
    CHECK(Axis::of(player.inputs.paddle[0]).place == 12);
    CHECK(Axis::of(player.inputs.paddle[0]).moved == -127);
    CHECK(Axis::of(player.inputs.paddle[1]).place == 12);
    CHECK(Axis::of(player.inputs.paddle[1]).moved == -127);
  }
}

TEST_CASE("A gun is aimed at a place, or moved by two pixels in each frame, and stays on the picture") {
  Player player = with(Controller::kJoystick, Controller::kLightGun);
  const auto place = [&] {
    return std::array{Axis::of(player.inputs.paddle[2]).place, Axis::of(player.inputs.paddle[3]).place};
  };
  player.press(0, 1.0F, 18, 0.0F);
  CHECK(place() == std::array{80, 105});
  player.press(0, 1.0F, 18 + 1, 33 + 256.0F * 44);
  CHECK(place() == std::array{33, 44});
  CHECK(player.inputs.joystick[1] == kStickFire);
  player.press(0, 1.0F, 18 + 8, 1.0F);
  CHECK(place() == std::array{35, 46});
  for (int frame = 0; frame < 200; ++frame) player.press(0, 1.0F, 18 + 7, 1.0F);
  CHECK(place() == std::array{0, 0});
  player.press(0, 1.0F, 18, 255 + 256.0F * 255);
  CHECK(place() == std::array{159, 255});
}

}  // namespace
}  // namespace racebeam
