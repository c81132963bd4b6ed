#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "emulator/state/power_on.hpp"
#include "environment/input/effective_actions.hpp"
#include "games/game/actions.hpp"
#include "tests/support/crc.hpp"

namespace racebeam {
namespace {

std::vector<std::uint32_t> first_draws(std::uint32_t seed, std::size_t count) {
  MersenneTwister generator(seed);
  std::vector<std::uint32_t> draws(count);
  std::ranges::generate(draws, [&] { return static_cast<std::uint32_t>(generator()); });
  return draws;
}

// The actions that take effect when 1, 2, 3 ... are requested.
std::vector<int> performed(float p, std::uint32_t seed, int acts) {
  const Sticky sticky(p);
  MersenneTwister random(seed);
  Presses held;
  std::vector<int> actions;
  for (int i = 0; i < acts; ++i) {
    sticky.draw(random, {{1 + i % 17, 1.0F}, {18, 0.0F}}, held);
    actions.push_back(held.a.action);
  }
  return actions;
}

// docs/spec/environment.md, 17
TEST_CASE("The generator is the standard 32-bit Mersenne Twister") {
  CHECK(first_draws(0, 3) == std::vector{2357136044u, 2546248239u, 3071714933u});
  CHECK(first_draws(1, 3) == std::vector{1791095845u, 4282876139u, 3093770124u});
  CHECK(first_draws(123, 6) ==
        std::vector{2991312382u, 3062119789u, 1228959102u, 1840268610u, 974319580u, 2967327842u});
  CHECK(2991312382u / 4294967296.0 == Approx(0.696469187).epsilon(1e-8));
}

TEST_CASE("The system generator gives the power-on RAM and timers of the reference") {
  SystemGenerator source(4753849);
  std::uint32_t draws = 0;
  std::array<std::uint8_t, 128> ram;
  for (std::uint8_t& byte : ram) byte = static_cast<std::uint8_t>(source.draw(draws));
  CHECK(std::equal(ram.begin(), ram.begin() + 4, std::begin({0xB8, 0x96, 0xC0, 0x49})));
  CHECK(test::crc(ram) == 0x006CDA95);
  for (const unsigned timer : {58u, 51u, 32u, 74u, 65u, 64u}) CHECK(25 + source.draw(draws) % 75 == timer);
}

TEST_CASE("The system generator goes on wherever a restored machine stood") {
  SystemGenerator source(4753849);
  std::uint32_t drawn = 0;
  std::vector<std::uint32_t> draws(200);
  for (std::uint32_t& draw : draws) draw = source.draw(drawn);
  for (const std::uint32_t position : {0u, 150u, 3u}) {
    drawn = position;
    CHECK(source.draw(drawn) == draws[position]);
    CHECK(drawn == position + 1);
  }
}

TEST_CASE("Sticky actions repeat where the reference repeats") {
  CHECK(performed(0.25F, 123, 20) ==
        std::vector{1, 2, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 13, 15, 16, 16, 16, 2, 3});
}

TEST_CASE("With probability 0 each action is new, with 1 no action is") {
  CHECK(performed(0.0F, 123, 3) == std::vector{1, 2, 3});
  CHECK(performed(1.0F, 123, 3) == std::vector{0, 0, 0});
  CHECK(performed(7.5F, 123, 3) == std::vector{0, 0, 0});
}

TEST_CASE("A probability is rounded to six digits and compared in single precision") {
  CHECK(sticky_threshold(0.0F) == 0);
  CHECK(sticky_threshold(0.25F) == 1u << 30);
  CHECK(sticky_threshold(0.1F) == 429496736);  // of 0.1 in double precision: 429496730
  CHECK(sticky_threshold(0.001F) == 4294968);  // 4294967.5, rounded up
  CHECK(sticky_threshold(0.123456789F) == sticky_threshold(0.123457F));
  CHECK(sticky_threshold(0.123456789F) != sticky_threshold(0.123456F));
  CHECK(sticky_threshold(1.0F) == 1ULL << 32);
  CHECK(sticky_threshold(-1.0F) == 0);
}

TEST_CASE("Each frame takes two draws, and B's is the second") {
  const Sticky sticky(0.25F);
  MersenneTwister random(123), reference(123);
  Presses held;
  for (int i = 0; i < 100; ++i) {
    const Presses before = held, pressed{{i % 18, 0.5F}, {18 + i % 18, 0.25F}};
    sticky.draw(random, pressed, held);
    const bool new_a = reference() >= 1u << 30, new_b = reference() >= 1u << 30;
    CHECK(held.a.action == (new_a ? pressed : before).a.action);
    CHECK(held.b.action == (new_b ? pressed : before).b.action);
  }
  CHECK(random == reference);
}

constexpr Controller kStick = Controller::kJoystick;

Presses pressing(int a, int b = 18) { return {{a, 1.0F}, {b, 0.0F}}; }

TEST_CASE("Illegal actions and RESET act as NOOP, for both players") {
  const LegalActions skiing({0, 2, 3, 4, 5, 6, 7, 8, 9}, kStick, kStick);
  for (const auto& [a, replaced] : {std::pair{1, 0}, {2, 2}, {9, 9}, {10, 0}, {17, 0}, {40, 0}, {-5, 0}}) {
    CHECK(skiing.replace(pressing(a)).a.action == replaced);
  }
  for (const auto& [b, replaced] :
       {std::pair{19, 18}, {20, 20}, {27, 27}, {35, 18}, {40, 18}, {39, 18}, {3, 18}}) {
    CHECK(skiing.replace(pressing(0, b)).b.action == replaced);
  }
}

TEST_CASE("With joysticks, numbers that are not actions are refused") {
  const LegalActions all(all_actions(), kStick, kStick);
  for (const int a : {26, 35, 36, 41, 43, 50, 99}) {
    CHECK_THROWS_WITH(all.check(pressing(a)),
                      Catch::Contains("action " + std::to_string(a) + " of player A is out of range") &&
                          Catch::Contains("0 to 25"));
  }
  for (const int b : {41, 50, 1000})
    CHECK_THROWS_WITH(all.check(pressing(0, b)), Catch::Contains("18 to 35"));
  for (int a = 0; a < 18; ++a) CHECK_NOTHROW(all.check(pressing(a, 18 + a)));
  for (int a = 18; a < kConsoleActions; ++a) CHECK_NOTHROW(all.check(pressing(a)));
  CHECK_NOTHROW(all.check(pressing(40, 40)));
}

TEST_CASE("A controller's own actions are accepted where it is connected, from its player") {
  const LegalActions keys(all_actions(), Controller::kKeyboard, kStick);
  for (int a = kFirstKey; a < kFirstKey + kKeys; ++a) CHECK_NOTHROW(keys.check(pressing(a)));
  for (const int a : {38, 64, 160})
    CHECK_THROWS_WITH(keys.check(pressing(a)), Catch::Contains("its controller"));
  CHECK_THROWS_WITH(keys.check(pressing(0, 18 + kFirstKey)), Catch::Contains("of player B is out of range"));

  const LegalActions buttons(all_actions(), Controller::kGenesis, Controller::kBooster);
  for (int stick = 0; stick < 18; ++stick) {
    CHECK_NOTHROW(buttons.check(pressing(kWithC + stick, 18 + kWithBoth + stick)));
    CHECK_THROWS_AS(buttons.check(pressing(kWithTrigger + stick)), std::invalid_argument);
    CHECK_THROWS_AS(buttons.check(pressing(0, 18 + kWithC + stick)), std::invalid_argument);
  }
  CHECK_THROWS_AS(buttons.check(pressing(kWithC + 18)), std::invalid_argument);
}

TEST_CASE("With paddles, any number goes, but no strength that is not finite") {
  const LegalActions all(all_actions(), Controller::kPaddles, kStick);
  for (const int a : {18, 36, 41, 99, 1000000}) CHECK_NOTHROW(all.check(pressing(a, a)));
  CHECK_THROWS_WITH(all.check({{3, std::numeric_limits<float>::infinity()}, {18, 0.0F}}),
                    Catch::Contains("finite"));
  CHECK_THROWS_WITH(all.check({{3, 1.0F}, {18, std::numeric_limits<float>::quiet_NaN()}}),
                    Catch::Contains("finite"));
}

}  // namespace
}  // namespace racebeam
