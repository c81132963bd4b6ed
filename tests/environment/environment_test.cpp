// The environment with our own cartridge, whose RAM records what was done to it.
#include <catch2/catch.hpp>
#include <vector>

#include "emulator/tia/palette.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/crc.hpp"

namespace racebeam {
namespace {

using test::at;
using test::counted;
using test::counter_image;
using test::draws;
using test::game;
using test::kLives;
using test::kOver;
using test::kScore;
using test::plain;
using test::steered;

TEST_CASE("An act lasts frame_skip frames and takes two draws for each") {
  Settings settings = plain();
  for (const int skip : {0, 1, 4}) {
    settings.frame_skip = skip;
    Environment environment = steered(settings);
    environment.act(2);
    const int frames = skip == 0 ? 1 : skip;
    CHECK(environment.frame_number() == frames);
    CHECK(at(environment, 0x80) == counted(68 + frames));
    CHECK(draws(environment) == 2u * static_cast<unsigned>(frames));
  }
}

TEST_CASE("Actions reach the ports, player B's too, and go away again") {
  Environment environment = steered();
  environment.act(14, 18 + 9);  // UPRIGHTFIRE, DOWNLEFT
  CHECK(at(environment, 0x81) == 0x69);
  CHECK((at(environment, 0x83) & 0x80) == 0);
  CHECK((at(environment, 0x84) & 0x80) != 0);
  environment.act(0);
  CHECK(at(environment, 0x81) == 0xFF);
  CHECK((at(environment, 0x83) & 0x80) != 0);
}

TEST_CASE("The sum of rewards is clamped, not each frame's") {
  Settings settings = plain();
  settings.reward_min = -1;
  settings.reward_max = 5;
  Environment environment = steered(settings);
  environment.set_ram(kScore, 3);
  CHECK(environment.act(0) == 3);
  environment.set_ram(kScore, 60);
  CHECK(environment.act(0) == 5);
  environment.set_ram(kScore, 0);
  CHECK(environment.act(0) == -1);
}

TEST_CASE("After the end an act runs no frame, but draws, and returns 0 within the limits") {
  Settings settings = plain();
  settings.reward_min = 2;
  settings.frame_skip = 4;
  settings.sound = true;
  Environment environment = steered(settings);
  environment.set_ram(0x00, 0x20);  // a waveform whose period does not divide a block
  environment.set_ram(kOver, 1);
  CHECK_FALSE(environment.game_over());  // until the rule is evaluated after a frame
  environment.act(0);
  CHECK(environment.terminal());
  CHECK(environment.game_over());
  CHECK_FALSE(environment.truncated());
  CHECK(environment.frame_number() == 1);
  const std::vector<std::uint8_t> sound(environment.audio().begin(), environment.audio().end());
  const int frames = at(environment, 0x80);
  CHECK(environment.act(0) == 2);
  CHECK(environment.frame_number() == 1);
  CHECK(at(environment, 0x80) == frames);
  CHECK(draws(environment) == 16);
  CHECK(sound != std::vector<std::uint8_t>(environment.audio().begin(), environment.audio().end()));
  environment.reset_game();
  CHECK_FALSE(environment.game_over());
}

TEST_CASE("The frame limit truncates an episode, not the game") {
  Settings settings = plain();
  settings.frame_skip = 4;
  settings.max_episode_frames = 6;
  Environment environment = steered(settings);
  std::vector<int> frames;
  for (int i = 0; i < 4; ++i) {
    environment.act(0);
    frames.push_back(environment.frame_number());
    CHECK(environment.game_over() == (i > 0));
    CHECK(environment.truncated() == (i > 0));
    CHECK_FALSE(environment.terminal());
  }
  CHECK(frames == std::vector{4, 6, 6, 6});
  environment.reset_game();
  environment.act(0);
  CHECK(environment.frame_number() == 10);
  CHECK(environment.episode_frame_number() == 4);
}

TEST_CASE("Losing a life truncates when asked for") {
  const auto text =
      "title = \"L\"\n[rule]\nreset = { lives = 3 }\nstep = '''\nscore = 0\nterminal = 0\nlives = 3 - "
      "ram[0x92]\n'''\n";
  Settings settings = plain();
  settings.truncate_on_life_loss = true;
  Environment environment(counter_image(), game(text), settings);
  environment.act(0);
  CHECK_FALSE(environment.game_over());
  environment.set_ram(kLives, 1);
  environment.act(0);
  CHECK(environment.truncated());
  CHECK(environment.game_over());
  CHECK_FALSE(environment.terminal());
  environment.reset_game();
  CHECK_FALSE(environment.game_over());
}

TEST_CASE("Modes and difficulties that are not offered are refused") {
  Environment environment = steered();
  CHECK_THROWS_WITH(environment.set_mode(2), "steered has no mode 2; it offers 0, 1, 3");
  CHECK_THROWS_WITH(environment.set_difficulty(4), "steered has no difficulty 4; it offers 0, 1, 2, 3");
  environment.set_difficulty(3);
  environment.act(0);
  CHECK(at(environment, 0x82) == 0xFF);
  CHECK(environment.difficulty() == 3);
  environment.reset_game();
  CHECK(environment.difficulty() == 3);
}

TEST_CASE("Settings that make no sense are refused with a sentence") {
  const auto refused = [](auto change) {
    Settings settings = plain();
    change(settings);
    return [settings] { steered(settings); };
  };
  CHECK_THROWS_WITH(refused([](Settings& s) { s.frame_skip = -1; })(),
                    "frame_skip is -1; it must be 1 or more");
  CHECK_THROWS_WITH(refused([](Settings& s) { s.sticky = std::numeric_limits<float>::quiet_NaN(); })(),
                    Catch::Contains("not a number"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.reward_min = 2, s.reward_max = 1; })(),
                    Catch::Contains("reward_min (2)"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.paddle_min = 800000; })(),
                    Catch::Contains("paddle_min (800000)"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.paddle_min = -2; })(), Catch::Contains("paddle_min (-2)"));
}

TEST_CASE("A refused action changes nothing") {
  Environment environment = steered();
  const auto before = environment.save(true);
  CHECK_THROWS_AS(environment.act(26), std::invalid_argument);
  CHECK_THROWS_AS(environment.act(0, 41), std::invalid_argument);
  CHECK(draws(environment) == 0);
  CHECK(environment.frame_number() == 0);
}

TEST_CASE("RAM can be written, byte by byte, within its bounds") {
  Environment environment = steered();
  environment.set_ram(0x7F, 0x5A);
  CHECK(environment.ram()[0x7F] == 0x5A);
  environment.act(0);
  CHECK(environment.ram()[0x7F] == 0x5A);
  CHECK_THROWS_AS(environment.set_ram(128, 0), std::out_of_range);
  CHECK_THROWS_AS(environment.set_ram(-1, 0), std::out_of_range);
}

TEST_CASE("Sound is made on request, once an act") {
  Environment silent = steered();
  silent.act(0);
  CHECK(std::ranges::all_of(silent.audio(), [](std::uint8_t sample) { return sample == 0; }));
  Settings settings = plain();
  settings.sound = true;
  Environment audible = steered(settings);
  CHECK(std::ranges::all_of(audible.audio(), [](std::uint8_t sample) { return sample == 0; }));
  audible.act(0);
  CHECK(std::ranges::any_of(audible.audio(), [](std::uint8_t sample) { return sample > 128; }));
}

TEST_CASE("All audio has the samples of each frame: those of acts of one frame") {
  Settings settings = plain();
  settings.sound = true;
  Environment single = steered(settings);
  settings.frame_skip = 3;
  Environment skipping = steered(settings);
  skipping.make_all_audio(true);
  for (int act = 0; act < 20; ++act) {
    skipping.begin_audio();
    skipping.act(0);
    std::vector<std::uint8_t> expected;
    for (int frame = 0; frame < 3; ++frame) {
      single.act(0);
      expected.insert(expected.end(), single.audio().begin(), single.audio().end());
    }
    CHECK(std::ranges::equal(skipping.all_audio(), expected));
    CHECK(std::ranges::equal(skipping.audio(), single.audio()));
  }
  const auto saved = skipping.save();
  skipping.act(0);
  CHECK(skipping.all_audio().size() == 6 * kAudioSize);
  skipping.restore(*saved);
  CHECK(skipping.all_audio().empty());
  skipping.act(0);
  skipping.reset_game();
  CHECK(skipping.all_audio().empty());
}

TEST_CASE("Averaging blends the picture with the one before it") {
  Settings averaging = plain();
  averaging.color_averaging = true;
  Environment environment = steered(averaging), raw = steered();
  std::vector<std::uint8_t> before(raw.screen().begin(), raw.screen().end());
  for (int i = 0; i < 20; ++i) {
    environment.act(0);
    raw.act(0);
    const auto now = raw.screen();
    bool equal = true;
    for (std::size_t p = 0; p < now.size(); ++p) {
      equal = equal && environment.screen()[p] == blend(Format::kNtsc)(now[p], before[p]);
    }
    CHECK(equal);
    before.assign(now.begin(), now.end());
  }
}

// Draws 100 lines, thinks for longer than a step lasts, and draws 100 more; the colour is the frame's number.
std::shared_ptr<const Image> thinking_image() {
  constexpr std::uint8_t kProgram[] = {
      0xA9, 0x02,        // F000 frame LDA #2
      0x85, 0x00,        // F002       STA VSYNC
      0x85, 0x02,        // F004       STA WSYNC
      0xA9, 0x00,        // F006       LDA #0
      0x85, 0x00,        // F008       STA VSYNC      the frame closes here
      0x85, 0x91,        // F00A       STA $91        the game goes on
      0xE6, 0x80,        // F00C       INC $80
      0xA5, 0x80,        // F00E       LDA $80
      0x85, 0x09,        // F010       STA COLUBK
      0xA2, 0x64,        // F012       LDX #100
      0x85, 0x02,        // F014 upper STA WSYNC
      0xCA,              // F016       DEX
      0xD0, 0xFB,        // F017       BNE upper
      0xA0, 0x64,        // F019       LDY #100
      0xCA,              // F01B think DEX
      0xD0, 0xFD,        // F01C       BNE think
      0x88,              // F01E       DEY
      0xD0, 0xFA,        // F01F       BNE think
      0xA2, 0x64,        // F021       LDX #100
      0x85, 0x02,        // F023 lower STA WSYNC
      0xCA,              // F025       DEX
      0xD0, 0xFB,        // F026       BNE lower
      0x4C, 0x00, 0xF0,  // F028       JMP frame
  };
  std::vector<std::uint8_t> bytes(4096);
  std::ranges::copy(kProgram, bytes.begin());
  bytes[0xFFD] = 0xF0;
  return make_image(std::move(bytes), "thinking");
}

TEST_CASE("The screen before is what was shown a frame ago, even if the picture is the same") {
  Environment environment(thinking_image(), game(), plain());
  environment.set_drawing(Drawing::kEvery);
  std::vector<std::vector<std::uint8_t>> screens;
  for (int frame = 0; frame < 12; ++frame) {
    const auto screen = environment.screen();
    screens.emplace_back(screen.begin(), screen.end());
    environment.act(0);
    CHECK(std::ranges::equal(environment.previous_screen(), screens.back()));
  }
  CHECK(std::ranges::adjacent_find(screens, std::not_equal_to()) != screens.end());
}

TEST_CASE("RGB and grey pictures follow the palette") {
  Environment environment = steered();
  std::vector<std::uint8_t> rgb, grey;
  environment.screen_rgb(rgb);
  environment.screen_grey(grey);
  const auto screen = environment.screen();
  REQUIRE(screen.size() == static_cast<std::size_t>(environment.height() * kScreenWidth));
  REQUIRE(rgb.size() == 3 * screen.size());
  REQUIRE(grey.size() == screen.size());
  CHECK(screen[20000] == (counted(68) & 0xFE));  // the background that the program has set
  const Rgb colour = palette(Format::kNtsc)[screen[20000]];
  CHECK(Rgb{rgb[60000], rgb[60001], rgb[60002]} == colour);
  CHECK(grey[20000] == grey_table(Format::kNtsc)[screen[20000]]);
}

TEST_CASE("Frames repeat the action before, as a model of sticky actions says") {
  for (const int skip : {1, 4}) {
    Settings settings = plain();
    settings.sticky = 0.25F;
    settings.frame_skip = skip;
    Environment sticky = steered(settings), exact = steered();
    MersenneTwister random(123);
    Presses held;
    for (int i = 0; i < 60; ++i) {
      if (i == 30) {
        sticky.reset_game();
        exact.reset_game();
        held = {};
      }
      const Presses presses{{i * 7 % 18, 1.0F}, {18 + i * 5 % 18, 1.0F}};
      sticky.act(presses.a.action, presses.b.action);
      for (int frame = 0; frame < skip; ++frame) {
        Sticky(0.25F).draw(random, presses, held);
        exact.act(held.a.action, held.b.action);
      }
      CHECK(test::crc(sticky.ram()) == test::crc(exact.ram()));
      CHECK(test::crc(sticky.screen()) == test::crc(exact.screen()));
    }
  }
}

TEST_CASE("Illegal actions and RESET press nothing in an act") {
  Environment environment(
      counter_image(),
      game("title = \"L\"\nlegal = [\"NOOP\", \"UP\"]\n[rule]\nstep = '''\nscore = 0\nterminal = 0\n'''\n"),
      plain());
  for (const auto& [a, b, swcha] : {std::tuple{2, 20, 0xEE}, {3, 21, 0xFF}, {40, 40, 0xFF}}) {
    environment.act(a, b);
    CHECK(at(environment, 0x81) == swcha);
  }
  CHECK(at(environment, 0x86) == 8);  // frames with RESET held: those of the reset
}

TEST_CASE("A paddle game takes any number, a joystick game refuses") {
  Environment environment(
      counter_image(),
      game(
          "title = \"P\"\n[[image]]\nleft = \"paddles\"\n[rule]\nstep = '''\nscore = 0\nterminal = 0\n'''\n"),
      plain());
  CHECK_NOTHROW(environment.act(99, 99));
  CHECK(environment.frame_number() == 1);
  environment.act(1, 19);
  CHECK((at(environment, 0x81) & 0xC0) == 0);  // both fire buttons
  environment.act(2, 20);
  CHECK(at(environment, 0x81) == 0xFF);
}

}  // namespace
}  // namespace racebeam
