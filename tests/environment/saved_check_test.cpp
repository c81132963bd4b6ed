// What is wrong in a state is named. That whatever passes does no harm is snapshot_fuzz_test.cpp's business.
#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "environment/saved.hpp"
#include "environment/snapshot.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/random_image.hpp"

namespace racebeam {
namespace {

using Values = Environment::Saved::Values;

struct Wrong {
  const char* sentence;
  std::function<void(Values&)> spoil;
};

// `spoil` is told to change one field of a right state; the bytes' checksum is right all the same.
std::string refusal(Environment& environment, const std::function<void(Values&)>& spoil) {
  Environment::Saved saved = *environment.save(true);
  spoil(saved.values);
  try {
    from_bytes(to_bytes(saved), environment);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST_CASE("A state with a value that no machine has is refused by the field's name") {
  Environment environment = test::steered();
  for (int i = 0; i < 5; ++i) environment.act(i);
  REQUIRE(refusal(environment, [](Values&) {}).empty());
  const Wrong wrongs[] = {
      {"the cycle is -1", [](Values& v) { v.machine.cycle = -1; }},
      {"the number of draws", [](Values& v) { v.machine.drawn = 0xFFFFFFFF; }},
      {"the processor's status", [](Values& v) { v.machine.cpu.P |= 0x10; }},
      {"the processor's jam flag is 2; it must be from 0 to 1", [](Values& v) { v.machine.cpu.jammed = 2; }},
      {"the timer's shift is 40; it must be 0, 3, 6 or 10", [](Values& v) { v.machine.riot.shift = 40; }},
      {"a player's position is 160", [](Values& v) { v.machine.tia.player[1].position = 160; }},
      {"a player's motion is 16", [](Values& v) { v.machine.tia.player[0].motion = 16; }},
      {"a player's NUSIZ", [](Values& v) { v.machine.tia.player[0].nusiz = 8; }},
      {"a missile's position is 255", [](Values& v) { v.machine.tia.missile[0].position = 255; }},
      {"the ball's position is 200", [](Values& v) { v.machine.tia.ball.position = 200; }},
      {"the Cosmic Ark count", [](Values& v) { v.machine.tia.cosmic_count = 4; }},
      {"the Cosmic Ark shape", [](Values& v) { v.machine.tia.cosmic_shape = static_cast<CosmicShape>(3); }},
      {"the frame's origin is 3", [](Values& v) { v.machine.tia.origin = 3; }},
      {"the clocks left on the line is 229", [](Values& v) { v.machine.tia.left = 229; }},
      {"the beam's clock", [](Values& v) { v.machine.tia.cursor = 1 << 30; }},
      {"the next pixel", [](Values& v) { v.machine.tia.pixel += 160; }},
      {"the collisions", [](Values& v) { v.machine.tia.collisions |= 1U << 12; }},
      {"the number of lines", [](Values& v) { v.machine.frame.lines = -1; }},
      {"the flag of a greyed frame", [](Values& v) { v.machine.frame.greyed = 1, v.machine.frame.open = 0; }},
      {"a bank of the cartridge", [](Values& v) { v.machine.cartridge.bank[3] = 1; }},
      {"a paddle's resistance is -1", [](Values& v) { v.machine.inputs.paddle[2] = -1; }},
      {"a joystick is 32", [](Values& v) { v.machine.inputs.joystick[1] = 32; }},
      {"strength", [](Values& v) { v.play.held.a.strength = std::numeric_limits<float>::quiet_NaN(); }},
      {"a turned paddle", [](Values& v) { v.play.paddles[0] = -5; }},
      {"the frame number is 4294967295", [](Values& v) { v.play.frames = 0xFFFFFFFF; }},
      {"the mode is 2; it must be one of 0, 1, 3", [](Values& v) { v.play.mode = 2; }},
      {"the difficulty is 9; it must be one of", [](Values& v) { v.play.difficulty = 9; }},
      {"the flag of an old RAM", [](Values& v) { v.play.ram_is_stale = 2; }},
      {"a variable that the rule has not", [](Values& v) { v.tally.values.back() = 1; }},
      {"the divider of a sound channel is 32", [](Values& v) { v.sound.channel[1].divider = 32; }},
  };
  for (const Wrong& wrong : wrongs) {
    INFO(wrong.sentence);
    CHECK_THAT(refusal(environment, wrong.spoil), Catch::Contains(wrong.sentence));
  }
}

TEST_CASE("A state with a bank that the cartridge has not is refused") {
  for (const char* scheme : {"F8", "F8SC", "F6", "F4", "E0", "3F", "FE", "2K"}) {
    INFO(scheme);
    const auto game = std::make_shared<const Game>(game_without_rule("random"));
    Environment environment(test::random_image(scheme, 1), game, test::plain());
    REQUIRE(refusal(environment, [](Values&) {}).empty());
    CHECK_THAT(refusal(environment, [](Values& v) { v.machine.cartridge.bank[0] = 0xFF; }),
               Catch::Contains("bank"));
    CHECK_THAT(refusal(environment, [](Values& v) { v.machine.cartridge.bank[7] = 1; }),
               Catch::Contains("bank"));
  }
}

TEST_CASE("A generator that can't be one is refused") {
  Environment environment = test::steered();
  auto saved = *environment.save(true);
  std::stringstream zeros;
  for (int i = 0; i < 624; ++i) zeros << "0 ";
  zeros << 7;
  zeros >> *saved.random;
  CHECK_THROWS_WITH(from_bytes(to_bytes(saved), environment), Catch::Contains("generator are all 0"));
}

}  // namespace
}  // namespace racebeam
