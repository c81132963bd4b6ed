#include "cli/commands/background.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agents/features/game_facts.hpp"
#include "agents/features/tile_colours.hpp"
#include "cli/arguments/image_options.hpp"
#include "cli/arguments/options.hpp"
#include "cli/commands/png_file.hpp"
#include "emulator/tia/palette.hpp"
#include "recording/atomic_file.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr auto kFooter =
    R"(Plays random actions, and finds the most frequent colour of each pixel. Basic and BASS leave it out of the screen.
Writes to FOLDER:
  GAME.background      for experiments: they take it from RESULTS/games if seed and number of screens are theirs
  GAME.csv             the same: 210 lines of 160 colours from 0 to 127
  GAME-background.png  the same as a picture
  GAME-secam.png       a screen in SECAM's eight colours
  GAME-tiles.png       the colours that BASS sees of that screen: each tile in stripes of them

Example:
  racebeam background asterix --roms ~/atari --into pictures)";

constexpr int kMostScreens = 10000000, kGridWidth = 16, kGridHeight = 14, kSecamColours = 8;
constexpr std::size_t kMostCsvBytes = std::size_t{1} << 20;

struct Options {
  std::string game, into, csv;
  SampleSettings samples;
  ImageOptions images;
};

using Colours = std::vector<std::uint8_t>;  // palette indices of 160 x 210 pixels

void write_picture(const std::string& path, const Colours& colours, Format format) {
  std::vector<std::uint8_t> rgb;
  for (const std::uint8_t index : colours) {
    const Rgb& colour = palette(format)[index & ~1U];
    rgb.insert(rgb.end(), {colour.r, colour.g, colour.b});
  }
  write_png(path, rgb);
}

// A screen of random play that is not the first.
Colours sample(const Cartridge& cartridge, const SampleSettings& settings) {
  Colours screen;
  FeatureScreen features;
  sample_screens(cartridge, settings, 60, settings.seed, [&](const Environment& machine) {
    const Screen pixels = features.of(machine);
    screen.assign(pixels.begin(), pixels.end());
  });
  return screen;
}

// Each tile in stripes of the colours that are in it.
Colours tiles_of(const Background& background, const Colours& screen) {
  const TileColours set(background, kGridWidth, kGridHeight, kSecamColours, false);
  ActiveFeatures active;
  set.extract(Screen(screen.data(), kFeaturePixels), active);
  std::vector<std::vector<std::uint8_t>> tiles(kGridWidth * kGridHeight);
  for (const std::uint32_t feature : active.indices)
    tiles[feature / kSecamColours].push_back(static_cast<std::uint8_t>(feature % kSecamColours * 2));
  Colours picture(kFeaturePixels);
  for (std::size_t pixel = 0; pixel < picture.size(); ++pixel) {
    const std::size_t x = pixel % kFeatureWidth, y = pixel / kFeatureWidth;
    constexpr std::size_t kWide = kFeatureWidth / kGridWidth, kHigh = kFeatureHeight / kGridHeight;
    const auto& colours = tiles[y / kHigh * kGridWidth + x / kWide];
    if (!colours.empty()) picture[pixel] = colours[x % kWide * colours.size() / kWide];
  }
  return picture;
}

Colours in_secam(Colours screen) {
  for (std::uint8_t& index : screen) index = static_cast<std::uint8_t>(secam_of(colour_of(index)) << 1);
  return screen;
}

Colours indices_of(const Background& background) {
  Colours indices(background.begin(), background.end());
  for (std::uint8_t& colour : indices) colour = static_cast<std::uint8_t>(colour << 1);
  return indices;
}

void run(const Options& options) {
  const Images images = images_of(options.images);
  const Cartridge* const cartridge = images.find(options.game);
  if (!cartridge)
    throw InvalidInput("no image is here of '" + options.game + "'; --roms names the folder that holds it");
  const Background background =
      options.csv.empty()
          ? discover_background(*cartridge, options.samples)
          : background_of_csv(options.csv, read_input_file("background", options.csv, kMostCsvBytes));
  std::filesystem::create_directories(options.into);
  const std::string base = options.into + '/' + cartridge->game->name;
  replace_file(base + ".background", bytes_of(background, *cartridge, options.samples), Durable::kLater);
  replace_file(base + ".csv", csv_of(background), Durable::kLater);
  const Colours screen = sample(*cartridge, options.samples);
  write_picture(base + "-background.png", indices_of(background), Format::kNtsc);
  write_picture(base + "-secam.png", in_secam(screen), Format::kSecam);
  write_picture(base + "-tiles.png", tiles_of(background, screen), Format::kSecam);
  std::printf("%s.background and its pictures are written\n", base.c_str());
}

}  // namespace

void add_background(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  Settings& machine = options->samples.play.machine;
  machine.frame_skip = 5;
  machine.sticky = 0;
  machine.max_episode_frames = 18000;
  CLI::App& command = *app.add_subcommand("background", "Discover the still part of a game's screen");
  command.add_option("GAME", options->game, "The game, by its name")->required();
  command.add_option("--into", options->into, "The folder of the files that are written")->required();
  command.add_option("--csv", options->csv, "Take the background from this file: 210 lines of 160 colours");
  command.add_option("--seed", options->samples.seed, "Seed of the random play")
      ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()))
      ->capture_default_str();
  command.add_option("--screens", options->samples.background_screens, "Screens that are looked at")
      ->check(whole_number(1, kMostScreens))
      ->capture_default_str();
  add_image_options(command, options->images);
  command.footer(kFooter);
  command.callback([options] { run(*options); });
}

}  // namespace racebeam
