// Messages of the environment of an RL-Glue experiment (docs/spec/classic-protocol.md, 11).
#include "protocol/classic/rl_glue.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/environment/steered.hpp"

using namespace racebeam;
using Catch::Contains;
using namespace std::string_literals;

namespace {

constexpr std::uint32_t kInit = 11, kStart = 12, kStep = 13, kCleanup = 14, kMessage = 19, kTerminate = 35;

Environment machine(const std::string& more = "") {
  Settings settings;
  settings.classic = true;
  settings.sticky = 0;
  return {test::counter_image(), test::game("minimal = [\"NOOP\", \"UP\"]\n" + (test::kSteeredGame + more)),
          settings};
}

std::string number(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

std::uint32_t number_at(std::string_view bytes, std::size_t place) {
  std::uint32_t value = 0;
  for (const char byte : bytes.substr(4 * place, 4)) value = value << 8 | static_cast<std::uint8_t>(byte);
  return value;
}

// An action of one whole number.
std::string action(std::uint32_t index) { return number(1) + number(0) + number(0) + number(index); }

// The core of an experiment, which asks an environment. ask() returns the payload of the reply.
struct Core {
  explicit Core(const RlGlueOptions& options = {}) : glue(game, options) {}

  std::string ask(std::uint32_t type, const std::string& payload = "") {
    const std::string reply = glue.answer(type, payload).value();
    const RlGlueHeader header = rl_glue_header(std::string_view(reply).substr(0, kRlGlueHeaderBytes));
    CHECK(header.type == type);
    CHECK(header.size == reply.size() - kRlGlueHeaderBytes);
    return reply.substr(kRlGlueHeaderBytes);
  }

  Environment game = machine();
  RlGlueEnvironment glue;
};

constexpr std::size_t kRewardEnd = 12;  // a reply to a step begins with the end and the reward
constexpr std::uint32_t kPixels = 210 * 160;

}  // namespace

TEST_CASE("An RL-Glue environment greets, and answers the messages of the core in their types") {
  CHECK(rl_glue_greeting() == number(3) + number(0));
  Core core;
  CHECK(core.ask(kCleanup).empty());
  CHECK(core.ask(kMessage, "words\0"s) == "words\0"s);
  CHECK_FALSE(core.glue.answer(kTerminate, ""));
  for (const std::uint32_t unknown : {0U, 10U, 15U, 18U, 20U, 36U})
    CHECK_THROWS_WITH(core.glue.answer(unknown, ""), Contains("of type " + std::to_string(unknown) + ";"));
}

TEST_CASE("The task names the colours and the number of actions, after its length") {
  for (const bool rgb : {false, true}) {
    for (const bool minimal : {false, true}) {
      const std::string task = Core({.rgb = rgb, .minimal_actions = minimal}).ask(kInit);
      CHECK(number_at(task, 0) == task.size() - 4);
      CHECK_THAT(task, Contains(rgb ? "(100800 0 255)" : "(33600 0 127)"));
      CHECK_THAT(task, Contains(minimal ? "ACTIONS INTS (0 2)" : "ACTIONS INTS (0 18)"));
    }
  }
}

TEST_CASE("An observation is RAM and the screen, a whole number for each byte") {
  for (const bool rgb : {false, true}) {
    Core core({.rgb = rgb});
    core.ask(kStart);
    const std::string step = core.ask(kStep, action(0));
    const std::string_view seen = std::string_view(step).substr(kRewardEnd);
    const std::uint32_t numbers = 128 + (rgb ? 3 : 1) * kPixels;
    CHECK(number_at(seen, 0) == numbers);
    CHECK(number_at(seen, 1) == 0);
    CHECK(number_at(seen, 2) == 0);
    REQUIRE(seen.size() == 4 * (3 + std::size_t{numbers}));
    std::vector<std::uint8_t> pixels(core.game.screen().begin(), core.game.screen().end());
    if (rgb) core.game.screen_rgb(pixels);
    for (std::size_t i = 0; i < kRamSize; ++i) REQUIRE(number_at(seen, 3 + i) == core.game.ram()[i]);
    for (std::size_t i = 0; i < pixels.size(); ++i) REQUIRE(number_at(seen, 3 + kRamSize + i) == pixels[i]);
  }
}

TEST_CASE("A step plays the action of its index, and NOOP for an index that no action has") {
  // $81 shows the joystick: bit 4 is low while UP is pressed.
  for (const bool minimal : {false, true}) {
    Core core({.minimal_actions = minimal});
    core.ask(kStart);
    const auto is_up = [&](std::uint32_t index) {
      core.ask(kStep, action(index));
      CHECK((core.game.ram()[4] & 0x80) != 0);  // player B presses nothing
      return (core.game.ram()[1] & 0x10) == 0;
    };
    CHECK(is_up(minimal ? 1 : 2));
    CHECK_FALSE(is_up(0));
    CHECK_FALSE(is_up(minimal ? 2 : 18));
    CHECK_FALSE(is_up(0xFFFFFFFF));
  }
}

TEST_CASE("A step has the end and the reward of its act, and a start begins a new game") {
  Core core;
  core.ask(kStart);
  core.game.set_ram(test::kScore, 5);
  std::string step = core.ask(kStep, action(0));
  CHECK(number_at(step, 0) == 0);
  CHECK(step.substr(4, 8) == "\x40\x14\0\0\0\0\0\0"s);  // 5 as a double
  core.game.set_ram(test::kOver, 1);
  step = core.ask(kStep, action(0));
  CHECK(number_at(step, 0) == 1);
  CHECK(step.substr(4, 8) == std::string(8, '\0'));
  const std::string start = core.ask(kStart);
  CHECK(start.size() == 4 * (3 + std::size_t{128} + kPixels));
  CHECK_FALSE(core.game.terminal());
}

TEST_CASE("An action without a whole number is refused") {
  Core core;
  for (const std::string& wrong :
       {""s, action(0).substr(0, 15), number(0) + number(0) + number(1) + number(7)})
    CHECK_THROWS_WITH(core.glue.answer(kStep, wrong),
                      Contains(std::to_string(wrong.size()) + " bytes without a whole number"));
}

TEST_CASE("The session is over after its frames") {
  Core core({.max_num_frames = 2});
  core.ask(kStart);
  core.ask(kStep, action(0));
  core.ask(kStep, action(0));
  for (const std::uint32_t type : {kStart, kStep, kMessage}) CHECK_FALSE(core.glue.answer(type, action(0)));
}

TEST_CASE("A game whose screen does not have 210 rows is refused") {
  Environment tall = machine("[[image]]\nheight = 211\n");
  CHECK_THROWS_WITH(RlGlueEnvironment(tall, {}), Contains("has 211 rows; RL-Glue takes games with 210"));
}
