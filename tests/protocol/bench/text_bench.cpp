// Measures the text of a screen, as the mean over all games with an image. Not a test.
//   build/release/tests/protocol/text_bench            with RACEBEAM_SIMD=plain: the portable variant
#include <time.h>

#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "environment/environment.hpp"
#include "protocol/encoding/text.hpp"
#include "tests/support/roms.hpp"

namespace racebeam {
namespace {

constexpr int kFrames = 600, kEvery = 10;  // of random play; a screen of every tenth frame
constexpr int kRounds = 20;

using Screen = std::vector<std::uint8_t>;
using Append = void (*)(std::string&, std::span<const std::uint8_t>);

double seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

std::vector<Screen> play(const std::shared_ptr<const Image>& image, const std::shared_ptr<const Game>& game) {
  Environment environment(image, game, {});
  std::mt19937 random(7);
  std::vector<Screen> screens;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (environment.game_over()) environment.reset_game();
    environment.act(game->legal_actions[random() % game->legal_actions.size()]);
    if (frame % kEvery != 0) continue;
    const auto screen = environment.screen();
    screens.emplace_back(screen.begin(), screen.end());
  }
  return screens;
}

struct Cost {
  double microseconds = 0, characters = 0;  // a screen
};

Cost measure(const std::vector<Screen>& screens, Append append) {
  std::string text;
  std::size_t characters = 0;
  const double start = seconds();
  for (int round = 0; round < kRounds; ++round) {
    for (const Screen& screen : screens) {
      text.clear();
      append(text, screen);
      characters += text.size();
    }
  }
  const double count = kRounds * static_cast<double>(screens.size());
  return {(seconds() - start) / count * 1e6, static_cast<double>(characters) / count};
}

int run() {
  std::printf("%-20s %10s %10s %10s %10s\n", "", "rle, us", "characters", "hex, us", "characters");
  Cost sums[2], worst[2];
  int games = 0;
  for (const CatalogueEntry& entry : catalogue()) {
    const auto game = find_game(entry.name);
    const auto image = entry.has_rule ? test::find_rom_of(*game) : nullptr;
    if (!image) continue;
    const auto screens = play(image, game);
    const Cost costs[2] = {
        measure(screens, [](std::string& out, auto screen) { append_run_length(out, screen); }),
        measure(screens, [](std::string& out, auto screen) { append_hex(out, screen); })};
    std::printf("%-20s %10.2f %10.0f %10.2f %10.0f\n", game->name.c_str(), costs[0].microseconds,
                costs[0].characters, costs[1].microseconds, costs[1].characters);
    for (int i = 0; i < 2; ++i) {
      sums[i].microseconds += costs[i].microseconds;
      sums[i].characters += costs[i].characters;
      worst[i].microseconds = std::max(worst[i].microseconds, costs[i].microseconds);
    }
    ++games;
  }
  if (games == 0) {
    std::puts("no image was found (RACEBEAM_ROMS, or scripts/reference)");
    return 1;
  }
  std::printf("%-20s %10.2f %10.0f %10.2f %10.0f   of %d games\n", "mean", sums[0].microseconds / games,
              sums[0].characters / games, sums[1].microseconds / games, sums[1].characters / games, games);
  std::printf("%-20s %10.2f %10s %10.2f\n", "worst", worst[0].microseconds, "", worst[1].microseconds);
  return 0;
}

}  // namespace
}  // namespace racebeam

int main() { return racebeam::run(); }
