// Our own games on the bare console: what a player relies on.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <string>

#include "emulator/console.hpp"
#include "games/catalogue.hpp"

using namespace racebeam;

namespace {

// RAM of both games, as their sources map it.
constexpr int kPhase = 0, kLives = 1, kScore = 2, kWave = 5;
constexpr int kBeamfallShipX = 6, kBeamfallCells = 15;
constexpr int kUpdraftBalloonRow = 6;
constexpr int kPlaying = 1, kOver = 0;

// Collision latches, two bits a register: TiaState::collisions.
constexpr unsigned kM0P1 = 1u << 1, kM1P0 = 1u << 3, kP0Pf = 1u << 5, kP0Ball = 1u << 4;
constexpr unsigned kM0Pf = 1u << 9, kM1Pf = 1u << 11, kBallPf = 1u << 13, kP0P1 = 1u << 15;

constexpr int kPaddleMiddle = 408823, kPaddleLeast = 27450, kPaddleMost = 790196;

class Player {
 public:
  explicit Player(const std::string& name)
      : image_(load_image("builtin:" + name)),
        power_on_(4753849),
        console_(image_->bytes, properties(name), power_on_) {
    console_.inputs().paddle = {kPaddleMiddle, kPaddleMiddle, 0, 0};
    frames(60);
    press_reset();
    longest = 0, shortest = 1000;  // the first frames after power-on may be irregular
  }

  void press_reset() {
    console_.inputs().switches &= static_cast<std::uint8_t>(~kSwitchReset);
    frames(4);
    console_.inputs().switches |= kSwitchReset;
  }

  void frames(int count) {
    for (int i = 0; i < count; ++i) {
      console_.step();
      longest = std::max(longest, console_.state().frame.lines);
      shortest = std::min(shortest, console_.state().frame.lines);
      collisions |= console_.state().tia.collisions;
      for (int channel : {0, 1})
        loudest[channel] = std::max(loudest[channel], console_.sound().registers[4 + channel]);
    }
  }

  // All controls of a player, held for a few frames at a time.
  void play_at_random(std::mt19937& random) {
    Inputs& inputs = console_.inputs();
    inputs.joystick[0] = static_cast<std::uint8_t>(random() & 31);
    inputs.paddle_fire = static_cast<std::uint8_t>(random() & 1);
    const int turn = static_cast<int>(random() % 3) - 1;
    inputs.paddle[0] = std::clamp(inputs.paddle[0] + turn * 46000, kPaddleLeast, kPaddleMost);
    frames(2);
  }

  Inputs& inputs() { return console_.inputs(); }
  int ram(int index) const { return console_.ram()[static_cast<std::size_t>(index)]; }
  void set_ram(int index, int value) { console_.set_ram(index, static_cast<std::uint8_t>(value)); }
  int score() const { return (bcd(kScore) * 100 + bcd(kScore + 1)) * 100 + bcd(kScore + 2); }

  int longest = 0, shortest = 1000;
  unsigned collisions = 0;
  std::array<std::uint8_t, 2> loudest{};

 private:
  static Properties properties(const std::string& name) {
    const auto game = find_game(name);
    return game->images.empty() ? Properties{} : game->images.front().properties;
  }
  int bcd(int index) const { return (ram(index) >> 4) * 10 + (ram(index) & 15); }

  std::shared_ptr<const Image> image_;
  SystemGenerator power_on_;
  Console console_;
};

}  // namespace

TEST_CASE("every frame of our games has 262 lines, whatever the player does") {
  const std::string name = GENERATE("beamfall", "updraft");
  INFO(name);
  std::mt19937 random(1);
  Player player(name);
  for (int wave : {0, 4, 8}) {
    player.set_ram(kWave, wave);
    for (int i = 0; i < 1500; ++i) player.play_at_random(random);  // with the end of the game, and after it
    player.press_reset();
    player.set_ram(kWave, wave);
    for (int i = 0; i < 1500; ++i) {
      player.set_ram(kLives, 4);
      player.play_at_random(random);
    }
  }
  CHECK(player.shortest == 262);
  CHECK(player.longest == 262);
}

TEST_CASE("random play scores, loses every life and is over within two minutes") {
  const std::string name = GENERATE("beamfall", "updraft");
  std::mt19937 random(GENERATE(1u, 2u, 3u, 4u, 5u));
  INFO(name);
  Player player(name);
  CHECK(player.ram(kPhase) == kPlaying);
  CHECK(player.ram(kLives) == 4);
  int most = 0, frames = 0;
  for (; player.ram(kPhase) != kOver && frames < 2 * 60 * 60; frames += 2) {
    player.play_at_random(random);
    CHECK(player.score() >= most);
    most = player.score();
  }
  CHECK(frames < 2 * 60 * 60);
  CHECK(frames > 5 * 60);
  CHECK(most > 0);
  CHECK(player.ram(kLives) == 0);
  CHECK(player.score() == most);  // it stays on the screen
}

TEST_CASE("FIRE starts a new game after the end") {
  const std::string name = GENERATE("beamfall", "updraft");
  INFO(name);
  Player player(name);
  for (int i = 0; i < 7200 && player.ram(kPhase) != kOver; ++i) player.frames(1);
  REQUIRE(player.ram(kPhase) == kOver);
  player.frames(120);
  CHECK(player.ram(kPhase) == kOver);
  player.inputs().joystick[0] = kStickFire;
  player.inputs().paddle_fire = 1;
  player.frames(2);
  CHECK(player.ram(kPhase) == kPlaying);
  CHECK(player.ram(kLives) == 4);
  CHECK(player.score() == 0);
}

TEST_CASE("our games use every kind of object, its collisions, and both sound channels") {
  const auto played = [](const std::string& name) {
    std::mt19937 random(7);
    Player player(name);
    for (int i = 0; i < 15000; ++i) {
      if (player.ram(kPhase) == kOver) player.press_reset();
      player.play_at_random(random);
    }
    CHECK(player.loudest[0] > 5);
    CHECK(player.loudest[1] > 5);
    return player.collisions;
  };
  const unsigned beamfall = kM0P1 | kM1P0 | kP0Pf | kP0Ball | kM0Pf | kM1Pf | kBallPf | kP0P1;
  CHECK((played("beamfall") & beamfall) == beamfall);
  const unsigned updraft = kM0P1 | kM1P0 | kP0Pf | kP0Ball | kP0P1;
  CHECK((played("updraft") & updraft) == updraft);
}

TEST_CASE("the difficulty switch narrows Beamfall's gap from seven cells to five") {
  Player player("beamfall");
  const auto gap = [&] {
    int dark = 0;
    for (int i = 0; i < 6; ++i)
      dark += 8 - std::popcount(static_cast<unsigned>(player.ram(kBeamfallCells + i)));
    return dark;
  };
  CHECK(gap() == 7);
  player.inputs().switches = kSwitchesAtRest | kSwitchLeftA;
  player.press_reset();
  CHECK(gap() == 5);
}

TEST_CASE("Beamfall's ship goes where the stick points and stays in the field") {
  Player player("beamfall");
  const int start = player.ram(kBeamfallShipX);
  player.inputs().joystick[0] = kStickRight;
  player.frames(20);
  CHECK(player.ram(kBeamfallShipX) == start + 30);
  player.inputs().joystick[0] = kStickLeft;
  player.frames(90);
  CHECK(player.ram(kBeamfallShipX) == 0);
}

TEST_CASE("Updraft's balloon floats where the paddle's charging time puts it") {
  for (int ohms : {150000, 300000, kPaddleMiddle, 500000, 620000}) {
    INFO(ohms);
    Player player("updraft");
    player.inputs().paddle[0] = ohms;
    player.frames(60);
    // Released 22 lines before the field; a row is two lines; 6 rows are half a balloon.
    const double lines = 1.6 * ohms * 0.01e-6 * 1.19e6 / 76;
    CHECK(player.ram(kUpdraftBalloonRow) == Approx(80 - (lines - 22) / 2 - 6).margin(1.5));
  }
}
