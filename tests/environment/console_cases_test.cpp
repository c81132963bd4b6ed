// docs/spec/console.md, "More cases": the effect of actions at the ports, and of the steps of a reset.
#include <algorithm>
#include <catch2/catch.hpp>

#include "emulator/console.hpp"
#include "environment/environment.hpp"
#include "environment/input/controller_input.hpp"
#include "tests/support/counter_image.hpp"
#include "tests/support/needed_rom.hpp"

namespace racebeam {
namespace {

struct Reset {
  const char* name;
  const char* md5;
  int soft_resets;  // with that of a mode program
  int completed;
};

constexpr Reset kResets[] = {
    {"seaquest", "240bfbac", 2, 68}, {"enduro", "94b92a88", 2, 69}, {"skiing", "b76fbadc", 2, 84},
    {"breakout", "f34f08e5", 3, 72}, {"qbert", "484b0076", 2, 60},  {"tetris", "b0e1ee07", 2, 60},
};

// How many steps of an environment's reset close a frame.
int completed_frames(const Image& image, const Game& game, int soft_resets) {
  SystemGenerator random(4753849);
  Console console(image.bytes, game.properties_for(image.md5), random);
  const ControllerInput hands(game.properties_for(image.md5), {});
  PaddleValues paddles = hands.middle();
  int completed = 0;
  const auto step = [&](int action) {
    hands.press(console.inputs(), {{action, 1.0F}, {18, 0.0F}}, {}, paddles);
    console.step();
    if (!console.state().frame.open) ++completed;
  };
  console.reset();
  for (int n = 0; n < 60; ++n) step(0);
  for (int n = 0; n < 4 * soft_resets; ++n) step(kResetAction);
  for (const int action : game.starting_actions) step(action);
  return completed;
}

void check_reset(const Reset& reset) {
  INFO(reset.name);
  const auto image = test::needed_rom(reset.name, reset.md5);
  if (!image) return;
  CHECK(completed_frames(*image, *find_game(reset.name), reset.soft_resets) == reset.completed);
}

TEST_CASE("Not every step of a reset completes a frame") {
  for (const Reset& reset : kResets) check_reset(reset);
}

Environment with_controllers(const std::string& image_keys) {
  Settings settings;
  settings.sticky = 0;
  return {test::counter_image(), test::game("title = \"C\"\n[[image]]\n" + image_keys), settings};
}

// SWCHA, and bit 7 of INPT4 and INPT5, after an action of each player.
struct Pins {
  int swcha;
  bool inpt4, inpt5;
  bool operator==(const Pins&) const = default;
};

Pins pins_after(const std::string& image_keys, int a, int b = 18) {
  Environment environment = with_controllers(image_keys);
  environment.act(a, b);
  const auto ram = environment.ram();
  return {ram[1], (ram[3] & 0x80) != 0, (ram[4] & 0x80) != 0};
}

TEST_CASE("With swapped ports, player A's stick is in the right one") {
  CHECK(pins_after("swap_ports = true\n", 10) == Pins{0xFE, true, false});
  CHECK(pins_after("", 10) == Pins{0xEF, false, true});
}

TEST_CASE("Paddle buttons are stick directions, and swapping paddles swaps them") {
  const std::string paddles = "left = \"paddles\"\n", swapped = paddles + "swap_paddles = true\n";
  CHECK(pins_after(paddles, 1) == Pins{0x7F, true, true});
  CHECK(pins_after(paddles, 0, 19) == Pins{0xBF, true, true});
  CHECK(pins_after(swapped, 1) == Pins{0xBF, true, true});
  CHECK(pins_after(swapped, 0, 19) == Pins{0x7F, true, true});
}

// Case 5. Three frames, then one that halts the CPU on line 100.
std::shared_ptr<const std::vector<std::uint8_t>> jamming_image() {
  constexpr std::uint8_t kProgram[] = {
      0xA9, 0x2E, 0x85, 0x09,                          // F000      LDA #$2E, STA COLUBK
      0xA9, 0x04, 0x85, 0x80,                          // F004      LDA #4, STA $80
      0xA9, 0x02, 0x85, 0x00,                          // F008 loop LDA #2, STA VSYNC
      0x85, 0x02, 0x85, 0x02, 0x85, 0x02,              // F00C      STA WSYNC, three times
      0xA9, 0x00, 0xC6, 0x80, 0xF0, 0x13, 0x85, 0x00,  // F012      LDA #0, DEC $80, BEQ last, STA VSYNC
      0xA2, 0x64, 0x85, 0x02, 0xCA, 0xD0, 0xFB,        // F01A      100 lines
      0xA2, 0x96, 0x85, 0x02, 0xCA, 0xD0, 0xFB,        // F021      150 lines
      0xF0, 0xDE,                                      // F028      BEQ loop
      0x00,                                            // F02A      never reached: BEQ above always branches
      0x85, 0x00,                                      // F02B last STA VSYNC
      0xA2, 0x64, 0x85, 0x02, 0xCA, 0xD0, 0xFB,        // F02D      100 lines
      0x02,                                            // F034      JAM
  };
  std::vector<std::uint8_t> bytes(4096);
  std::ranges::copy(kProgram, bytes.begin());
  bytes[0xFFD] = 0xF0;
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
}

bool all_are(std::span<const std::uint8_t> pixels, std::uint8_t colour) {
  return std::ranges::all_of(pixels, [=](std::uint8_t pixel) { return pixel == colour; });
}

TEST_CASE("A jammed processor leaves its last picture unfinished, greyed below, until a reset") {
  constexpr std::size_t kDrawn = 66 * 160;
  SystemGenerator random(4753849);
  Console console(jamming_image(), Properties{}, random);
  for (int n = 0; n < 4; ++n) {
    console.step();
    CHECK_FALSE(console.state().frame.open);
  }
  console.step();
  CHECK(console.state().frame.open);
  CHECK((3 * console.state().cycle - console.state().tia.origin) / 228 == 100);
  CHECK(all_are(console.picture().first(kDrawn), 0x2E));
  CHECK(all_are(console.picture().subspan(kDrawn), 0x07));

  const State jammed = console.state();
  const std::vector<std::uint8_t> picture(console.picture().begin(), console.picture().end());
  for (int n = 0; n < 3; ++n) console.step();
  CHECK(console.state().cycle == jammed.cycle);
  CHECK(console.state().riot.ram == jammed.riot.ram);
  CHECK(std::ranges::equal(console.picture(), picture));

  console.reset();
  console.step();
  CHECK_FALSE(console.state().frame.open);
}

}  // namespace
}  // namespace racebeam
