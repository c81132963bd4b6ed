#include "cli/commands/background.hpp"

#include <cstdio>
#include <memory>

#include "cli/arguments/subcommand.hpp"
#include "cli/commands/discovery.hpp"
#include "cli/commands/feature_pictures.hpp"
#include "recording/atomic_file.hpp"

namespace racebeam {
namespace {

constexpr auto kBackgroundFooter =
    R"(Plays random actions, and finds the most frequent colour of each pixel. Basic and BASS leave it out of the screen.
Writes to DIR:
  GAME.background      for experiments: they take it from RESULTS/games if seed and number of
                       screens are theirs. One from --csv is taken if the plan's [backgrounds]
                       has the SHA-256 of that file
  GAME.csv             the same: 210 lines of 160 colours from 0 to 127
  GAME-background.png  the same as a picture
  GAME-secam.png       a screen in SECAM's eight colours
  GAME-tiles.png       the colours that BASS sees of that screen: each tile in stripes of them

Example:
  racebeam background asterix --roms ~/atari --into pictures)";

void write_background_files(DiscoveryOptions& options) {
  const Images images = images_of(options.images);
  const Cartridge& cartridge = cartridge_of(images, options);
  const Background background = background_of(cartridge, options);
  const std::string base = write_background(background, cartridge, options);
  replace_file(base + ".csv", csv_of(background), Durable::kLater);
  const Colours screen = sample_screen(cartridge, options.samples).last;
  draw_background(base + "-background.png", background);
  draw_in_secam(base + "-secam.png", screen);
  draw_tiles(base + "-tiles.png", background, screen);
  std::printf("%s.background and its pictures are written\n", base.c_str());
}

}  // namespace

void add_background(Subcommand& program) {
  const auto options = std::make_shared<DiscoveryOptions>();
  Subcommand command =
      program.add_subcommand("background", "Discover the still part of a game's screen", kBackgroundFooter);
  add_discovery_options(command, *options);
  add_screens_option(command, "--screens", options->samples.background_screens,
                     "Screens from which the background is discovered");
  command.runs([options] { write_background_files(*options); });
}

}  // namespace racebeam
