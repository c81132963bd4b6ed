// Seeding and resets as in ALE 0.4 to 0.6 (classic-protocol.md, section 6).
#include <catch2/catch.hpp>

#include "environment/classic_power_on.hpp"
#include "environment/saved.hpp"
#include "tests/support/counter_image.hpp"

namespace racebeam {
namespace {

Settings classic(std::uint32_t seed = 123) {
  Settings settings;
  settings.random_seed = seed;
  settings.classic = true;
  settings.sticky = 0;
  return settings;
}

Environment counter(const Settings& settings) { return {test::counter_image(), test::game(), settings}; }

bool has_drawn(const Environment& environment, unsigned draws) {
  MersenneTwister expected(environment.settings().random_seed);
  expected.discard(draws);
  return *environment.save(true)->random == expected;
}

TEST_CASE("Power-on RAM comes from the environment's own seed") {
  const Environment environment = counter(classic());
  MersenneTwister random(123);
  bool same = true;
  for (std::size_t i = 0; i < 128; ++i) {
    const auto byte = static_cast<std::uint8_t>(random());
    if (i >= 0x20 && i < 0x70)
      same = same && environment.ram()[i] == byte;  // the program clears the first 32
  }
  CHECK(same);
}

TEST_CASE("The generator starts again after construction; a reset takes a draw, an act's frame two") {
  Environment environment = counter(classic());
  CHECK(has_drawn(environment, 1));
  environment.act(3);
  CHECK(has_drawn(environment, 3));
  environment.reset_game();
  CHECK(has_drawn(environment, 4));
}

TEST_CASE("A reset keeps the stored action, unlike that of ALE 0.12") {
  for (const bool is_classic : {true, false}) {
    Settings settings = classic();
    settings.classic = is_classic;
    Environment environment = counter(settings);
    environment.act(14, 20);
    environment.reset_game();
    const Presses held = environment.save()->values.play.held;
    CHECK(held.a.action == (is_classic ? 14 : 0));
    CHECK(held.b.action == (is_classic ? 20 : 18));
  }
}

TEST_CASE("Cartridge RAM is filled once, by a generator with the default seed") {
  MersenneTwister shared(1), expected;
  const MersenneTwister untouched = shared;
  ClassicPowerOn power_on(shared);
  std::array<std::uint8_t, 128> ram{};
  std::uint32_t drawn = 0;
  power_on.fill_cartridge(ram, drawn);
  for (const std::uint8_t byte : ram) CHECK(byte == static_cast<std::uint8_t>(expected()));
  CHECK(shared == untouched);
  ram.fill(7);
  power_on.fill_cartridge(ram, drawn);
  CHECK(std::ranges::all_of(ram, [](std::uint8_t byte) { return byte == 7; }));
}

TEST_CASE("Adventure has no mode program") {
  const auto text = std::string(test::kSteeredGame) + "[mode]\nsetup = '''\nselect 5\n'''\n";
  for (const bool is_classic : {true, false}) {
    Settings settings = classic();
    settings.classic = is_classic;
    const Environment adventure(test::counter_image(), test::game(text, "adventure"), settings);
    const Environment other(test::counter_image(), test::game(text, "other"), settings);
    CHECK(adventure.ram()[5] == (is_classic ? 0 : 5));  // frames with SELECT held
    CHECK(other.ram()[5] == 5);
  }
}

}  // namespace
}  // namespace racebeam
