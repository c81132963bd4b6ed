// Errors in a state are named; tests/emulator/state_check_test.cpp has those of the machine. That accepted
// states do no harm is tested in saved_state_fuzz_test.cpp.
#include <array>
#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/random_image.hpp"

namespace racebeam {
namespace {

using Values = Environment::Saved::Values;

struct Wrong {
  const char* sentence;
  std::function<void(Values&)> spoil;
};

// `spoil` changes one field of a valid state; the checksum of the bytes is right.
std::string refusal(Environment& environment, const std::function<void(Values&)>& spoil) {
  Environment::Saved saved = *environment.save(true);
  spoil(saved.values);
  try {
    from_bytes(to_bytes(saved, environment), environment);
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
      {"the cycle is 536870912", [](Values& v) { v.machine.cycle = kEndlessCycle; }},
      {"a cartridge of scheme 4K has no such banks", [](Values& v) { v.machine.cartridge.bank[3] = 1; }},
      {"the frame number of the episode", [](Values& v) { v.play.episode_frames = 1U << 31; }},
      {"strength", [](Values& v) { v.play.held.b.strength = std::numeric_limits<float>::infinity(); }},
      {"strength", [](Values& v) { v.play.held.a.strength = std::numeric_limits<float>::quiet_NaN(); }},
      {"a turned paddle", [](Values& v) { v.play.paddles[0] = -5; }},
      {"the frame number is 4294967295", [](Values& v) { v.play.frames = 0xFFFFFFFF; }},
      {"the mode is 2; it must be one of 0, 1, 3", [](Values& v) { v.play.mode = 2; }},
      {"the difficulty is 9; it must be one of", [](Values& v) { v.play.switches.difficulty = 9; }},
      {"the switches that actions have moved is 8; it must be from 0 to 7",
       [](Values& v) { v.play.switches.moved = 8; }},
      {"the flag of outdated RAM", [](Values& v) { v.play.ram_is_stale = 2; }},
      {"a variable that the rule does not have", [](Values& v) { v.rule.values.back() = 1; }},
      {"the divider of a sound channel is 32", [](Values& v) { v.sound.channel[1].divider = 32; }},
  };
  for (const Wrong& wrong : wrongs) {
    INFO(wrong.sentence);
    CHECK_THAT(refusal(environment, wrong.spoil), Catch::Contains(wrong.sentence));
  }
}

TEST_CASE("A state is accepted with each value at its limit") {
  Environment environment = test::steered();
  for (int i = 0; i < 5; ++i) environment.act(i);
  const auto highest = [](Values& values) {
    values.play.paddles.fill(std::numeric_limits<std::int32_t>::max());
    values.play.frames = values.play.episode_frames = 0x7FFFFFFF;
    values.play.mode = 3;
    values.play.switches = {3, 7};
    values.play.ram_is_stale = 1;
    for (auto& channel : values.sound.channel) channel.divider = 31;
  };
  CHECK(refusal(environment, highest).empty());
}

TEST_CASE("Cartridge RAM of another size is refused") {
  Environment environment{test::random_image("E7", 1), test::random_game("E7"), test::plain()};
  for (const int size : {0, 1024, 2047, 2049, 32768}) {
    Environment::Saved saved = *environment.save(true);
    saved.cartridge_ram.resize(static_cast<std::size_t>(size));
    CHECK_THROWS_WITH(from_bytes(to_bytes(saved, environment), environment),
                      Catch::Contains("bytes of cartridge RAM"));
  }
}

TEST_CASE("An impossible generator is refused") {
  Environment environment = test::steered();
  auto saved = *environment.save(true);
  saved.random =
      std::make_shared<const MersenneTwister>(std::array<std::uint32_t, MersenneTwister::kWords>{}, 7);
  CHECK_THROWS_WITH(from_bytes(to_bytes(saved, environment), environment),
                    Catch::Contains("generator are all 0"));
  saved.random = std::make_shared<const MersenneTwister>(MersenneTwister().words(), 625);
  CHECK_THROWS_WITH(from_bytes(to_bytes(saved, environment), environment),
                    Catch::Contains("position of the generator is 625; it must be from 0 to 624"));
}

}  // namespace
}  // namespace racebeam
