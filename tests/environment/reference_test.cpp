// Checksums of ALE 0.12, with commercial images (docs/spec/environment.md, 17; docs/spec/console.md, "How to
// check").
#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <vector>

#include "emulator/tia/palette.hpp"
#include "environment/environment.hpp"
#include "environment/saved_state.hpp"
#include "tests/support/crc.hpp"
#include "tests/support/needed_rom.hpp"

namespace racebeam {
namespace {

using test::crc;

struct Crcs {
  std::uint32_t screen, ram;
  bool operator==(const Crcs&) const = default;
};

Crcs now(const Environment& environment) { return {crc(environment.screen()), crc(environment.ram())}; }

Settings seeded(std::uint32_t seed, float sticky = 0) {
  Settings settings;
  settings.random_seed = seed;
  settings.sticky = sticky;
  return settings;
}

Environment load(const std::shared_ptr<const Image>& image, const char* name, const Settings& settings) {
  return {image, recognise(*image, name).game, settings};
}

int play_all_actions(Environment& environment, int acts) {
  int reward = 0;
  for (int i = 0; i < acts; ++i) reward += environment.act(i % 18);
  return reward;
}

struct Run {
  const char* name;
  const char* md5;
  Crcs loaded, reset, played;
  int reward;
};

constexpr Run kRuns[] = {
    {"tetris", "b0e1ee07", {0xF08B6DA5, 0xE218E161}, {0xF08B6DA5, 0xE218E161}, {0xFCEF3F04, 0xBBF1F69A}, 0},
    {"pong", "60e0ea3c", {0xBD9918E0, 0xAEC387E4}, {0xBD9918E0, 0xAEC387E4}, {0xEA95CB3A, 0xEE15BF8D}, -1},
    {"breakout", "f34f08e5", {0x0AE968E5, 0x553FC857}, {0x0AE968E5, 0x553FC857}, {0x596A1E30, 0x93B2B042}, 0},
    {"seaquest", "240bfbac", {0xBAB0B271, 0xB0C2AA61}, {0xBAB0B271, 0xB0C2AA61}, {0x37388D17, 0xEEE20A85}, 0},
    {"qbert", "484b0076", {0x53F3FD34, 0xC2A8FA9D}, {0x53F3FD34, 0xC2A8FA9D}, {0xBFB95A71, 0xBD550461}, 25},
    {"elevator_action",
     "71f8bacf",
     {0xA1822E52, 0x14E9C3C2},
     {0xA1822E52, 0x14E9C3C2},
     {0x4EA6E851, 0x9110BE7E},
     0},
    {"freeway", "8e0ab801", {0x15302DA0, 0x9223F348}, {0x15302DA0, 0x6ECB2525}, {0x35149E55, 0x25160074}, 0},
};

void check_run(const Run& run) {
  INFO(run.name);
  const auto image = test::needed_rom(run.name, run.md5);
  if (!image) return;
  Environment environment = load(image, run.name, seeded(123));
  CHECK(now(environment) == run.loaded);
  environment.reset_game();
  CHECK(now(environment) == run.reset);
  CHECK(play_all_actions(environment, 300) == run.reward);
  CHECK(now(environment) == run.played);
}

TEST_CASE("Load, reset and 300 acts give the screens and RAM of the reference") {
  for (const Run& run : kRuns) check_run(run);
}

struct Seen {
  const char* name;
  const char* md5;
  Crcs played;
  int reward;
  std::uint32_t rgb, grey;
};

constexpr Seen kSeen[] = {
    {"tetris", "b0e1ee07", {0xAB80F6EC, 0x91378BCE}, 0, 0xE8BD91C1, 0xEC83E44C},
    {"pong", "60e0ea3c", {0xA960BBA9, 0x4296F22B}, -1, 0x41215836, 0xCCD14678},
    {"breakout", "f34f08e5", {0x1493E320, 0xE6E867F3}, 0, 0x17A8B5E9, 0xD4368CF9},
    {"seaquest", "240bfbac", {0x6947FFBC, 0xCDDE2265}, 0, 0xDCBA403A, 0x46BEBAC9},
    {"freeway", "8e0ab801", {0xAB243D95, 0x2A280760}, 0, 0x977D57A2, 0xE373E277},
};

void check_seen(const Seen& expected) {
  INFO(expected.name);
  const auto image = test::needed_rom(expected.name, expected.md5);
  if (!image) return;
  Environment environment = load(image, expected.name, seeded(123, 0.25F));
  CHECK(play_all_actions(environment, 300) == expected.reward);
  CHECK(now(environment) == expected.played);
  std::vector<std::uint8_t> rgb, grey;
  environment.screen_rgb(rgb);
  environment.screen_grey(grey);
  CHECK(crc(rgb) == expected.rgb);
  CHECK(crc(grey) == expected.grey);
}

TEST_CASE("Sticky play gives the colours and greys of the reference") {
  for (const Seen& expected : kSeen) check_seen(expected);
}

struct Resets {
  const char* name;
  const char* md5;
  std::optional<std::vector<std::uint32_t>> ram;  // nothing: constant
};

void check_resets(const Resets& resets) {
  INFO(resets.name);
  const auto image = test::needed_rom(resets.name, resets.md5);
  if (!image) return;
  Environment environment = load(image, resets.name, seeded(1));
  const auto expected = resets.ram.value_or(std::vector(5, crc(environment.ram())));
  for (const std::uint32_t ram : expected) {
    CHECK(crc(environment.ram()) == ram);
    environment.reset_game();
  }
}

TEST_CASE("Each reset draws its own timer") {
  check_resets({"freeway", "8e0ab801", {{0x9223F348, 0x6ECB2525, 0x6ECB2525, 0x9223F348, 0x6ECB2525}}});
  check_resets({"seaquest", "240bfbac", {{0xB0C2AA61, 0xB0C2AA61, 0xB0C2AA61, 0xB0C2AA61, 0x4C2A7C0C}}});
  check_resets({"pong", "60e0ea3c", {}});
  check_resets({"tetris", "b0e1ee07", {}});
}

TEST_CASE("Counters stop at the frame limit and go on after a reset") {
  const auto image = test::needed_rom("tetris", "b0e1ee07");
  if (!image) return;
  Settings settings = seeded(123, 0.25F);
  settings.frame_skip = 4;
  settings.max_episode_frames = 6;
  Environment environment = load(image, "tetris", settings);
  MersenneTwister random(123);
  for (const int frames : {4, 6, 6, 6}) {
    environment.act(0);
    random.discard(8);
    CHECK(environment.frame_number() == frames);
    CHECK(*environment.save(true)->random == random);
    CHECK(environment.truncated() == (frames == 6));
    CHECK_FALSE(environment.terminal());
  }
  environment.reset_game();
  CHECK(environment.frame_number() == 6);
  CHECK(environment.episode_frame_number() == 0);
  environment.act(0);
  CHECK(environment.frame_number() == 10);
  CHECK(environment.episode_frame_number() == 4);
}

TEST_CASE("Pong's paddle turns, stops at its ends and is centred by a reset") {
  const auto image = test::needed_rom("pong", "60e0ea3c");
  if (!image) return;
  Environment environment = load(image, "pong", seeded(123));
  const auto paddle = [&] { return environment.save()->values.machine.inputs.paddle[0]; };
  CHECK(paddle() == 408823);
  for (const auto& [action, strength, value] :
       {std::tuple{3, 1.0F, 385823}, {4, 1.0F, 408823}, {4, 0.5F, 420323}, {4, -0.3333F, 427988}}) {
    environment.act(action, 18, strength);
    CHECK(paddle() == value);
  }
  for (int i = 0; i < 40; ++i) environment.act(3);
  CHECK(paddle() == 27450);
  for (int i = 0; i < 60; ++i) environment.act(4);
  CHECK(paddle() == 790196);
  environment.reset_game();
  CHECK(paddle() == 408823);
}

struct Ending {
  int acts, lives;
  bool terminal;
};

void check_breakout(const std::shared_ptr<const Image>& image, bool truncate, const Ending& ending) {
  Settings settings = seeded(1);
  settings.truncate_on_life_loss = truncate;
  Environment environment = load(image, "breakout", settings);
  int acts = 0;
  while (!environment.game_over() && acts < 1000) {
    environment.act(acts % 10 == 0 ? 1 : 0);
    ++acts;
  }
  CHECK(acts == ending.acts);
  CHECK(environment.lives() == ending.lives);
  CHECK(environment.terminal() == ending.terminal);
  const Crcs last = now(environment);
  CHECK(environment.act(0) == 0);
  CHECK(now(environment) == last);
  CHECK(environment.frame_number() == ending.acts);
}

TEST_CASE("Breakout ends with its balls, or with the first one if asked for") {
  const auto image = test::needed_rom("breakout", "f34f08e5");
  if (!image) return;
  check_breakout(image, true, {97, 4, false});
  check_breakout(image, false, {497, 0, true});
}

TEST_CASE("An act worth 20 returns 1 when rewards are clipped") {
  const auto image = test::needed_rom("seaquest", "240bfbac");
  if (!image) return;
  Settings settings = seeded(123);
  settings.frame_skip = 60;
  Environment plain = load(image, "seaquest", settings);
  settings.reward_min = -1;
  settings.reward_max = 1;
  Environment clipped = load(image, "seaquest", settings);
  bool met = false;
  for (int i = 0; i < 100 && !met; ++i) {
    const int action = 10 + i % 8;  // the eight directions with FIRE
    const int reward = plain.act(action);
    REQUIRE(clipped.act(action) == std::clamp(reward, -1, 1));
    met = reward == 20;
  }
  CHECK(met);
}

TEST_CASE("Writing Pong's score is a reward, and its end comes with the next frame") {
  const auto image = test::needed_rom("pong", "60e0ea3c");
  if (!image) return;
  Environment environment = load(image, "pong", seeded(123));
  environment.set_ram(14, 20);
  CHECK(environment.act(0) == 20);
  environment.set_ram(14, 21);
  CHECK_FALSE(environment.game_over());
  environment.act(0);
  CHECK(environment.game_over());
}

struct Start {
  const char* name;
  const char* md5;
  bool pal;
  Crcs start, after;
  std::uint32_t audio;
};

// In docs/spec/console.md, RAM and screen are in the reverse order.
constexpr Start kStarts[] = {
    {"seaquest",
     "240bfbac5163af4df5ae713985386f92",
     false,
     {0xbab0b271, 0xb0c2aa61},
     {0x7429b1e1, 0x2eb98225},
     0xc9714879},
    {"enduro",
     "94b92a882f6dbaa6993a46e2dcc58402",
     false,
     {0x12818f41, 0x2a4d4505},
     {0x2b341f45, 0xd6d71065},
     0xd6c0d847},
    {"qbert",
     "484b0076816a104875e00467d431c2d2",
     false,
     {0x53f3fd34, 0xc2a8fa9d},
     {0xe51acfab, 0xfee21f0f},
     0xa234c12f},
    {"montezuma_revenge",
     "3347a6dd59049b15a38394aa2dafa585",
     false,
     {0x3f37c0e7, 0xbfbdab7f},
     {0xdeace6a8, 0x0d6c32f7},
     0xa234c12f},
    {"robotank",
     "4f618c2429138e0280969193ed6c107e",
     false,
     {0x954d570b, 0x5dbd51a2},
     {0xbc689daf, 0xc515460c},
     0x002df5dd},
    {"elevator_action",
     "71f8bacfbdca019113f3f0801849057e",
     false,
     {0xa1822e52, 0x14e9c3c2},
     {0x97f47d4e, 0x4fc780cf},
     0xa234c12f},
    {"solaris",
     "e72eb8d4410152bdcb69e7fba327b420",
     false,
     {0x017357c3, 0xdc019b4e},
     {0xc51926fe, 0x9b46ca0d},
     0x0277a244},
    {"tetris",
     "b0e1ee07fbc73493eac5651a52f90f00",
     false,
     {0xf08b6da5, 0xe218e161},
     {0xbaa3a83a, 0x57714855},
     0xa234c12f},
    {"skiing",
     "367411b78119299234772c08df10e134",
     true,
     {0xcf33d017, 0x5e7c581a},
     {0x9ef64d40, 0xe44fdb1a},
     0x941fa1b8},
    {"amidar",
     "056f5d886a4e7e6fdd83650554997d0d",
     true,
     {0xe6a94479, 0xddef39c9},
     {0x1f1aee25, 0xba4c1f89},
     0xa234c12f},
    {"wizard_of_wor",
     "663ef22eb399504d5204c543b8a86bcd",
     true,
     {0xb185f261, 0x63937a52},
     {0xa214a95e, 0xe65cc4eb},
     0x1dcb39f9},
    {"breakout",
     "f34f08e5eb96e500e851a80be3277a56",
     false,
     {0x0ae968e5, 0x553fc857},
     {0x6c104ec8, 0x6a323933},
     0xa234c12f},
    {"pong",
     "60e0ea3cbe0913d39803477945e9e5ec",
     false,
     {0xbd9918e0, 0xaec387e4},
     {0xc1cc8649, 0x240b1e89},
     0xa234c12f},
};

void check_start(const Start& start) {
  constexpr int kActions[] = {1, 3, 3, 4, 2, 5, 0, 11};
  INFO(start.name);
  const auto image = test::needed_rom(start.name, start.md5);
  if (!image) return;
  Settings settings = seeded(1);
  settings.sound = true;
  Environment environment = load(image, start.name, settings);
  CHECK(environment.height() == (start.pal ? 250 : 210));
  CHECK(now(environment) == start.start);
  for (int i = 0; i < 200; ++i) environment.act(kActions[i / 5 % 8]);
  CHECK(now(environment) == start.after);
  CHECK(crc(environment.audio()) == start.audio);
}

TEST_CASE("Consoles start and play as the reference's, sound included") {
  for (const Start& start : kStarts) check_start(start);
}

}  // namespace
}  // namespace racebeam
