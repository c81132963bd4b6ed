#include "cli/commands/classes.hpp"

#include <cstdio>
#include <memory>

#include "cli/arguments/subcommand.hpp"
#include "cli/commands/discovery.hpp"
#include "cli/commands/feature_pictures.hpp"
#include "recording/atomic_file.hpp"

namespace racebeam {
namespace {

constexpr auto kClassesFooter =
    R"(Plays random actions, and finds objects: what is not the background. Objects of similar shapes are a class,
which is left out if it is rare, or stays within a small region. DISCO learns from where the objects of at most
ten classes are, and how they move.
Writes to DIR:
  GAME.background   the background, as racebeam background finds it
  GAME.classes      for experiments: they take both from RESULTS/games if seed and numbers of
                    screens are theirs
  GAME-classes.png  the most frequent shapes of each class: a line, and a colour, for each
  GAME-objects.png  a screen with its objects in the colours of their classes

Example:
  racebeam classes freeway --roms ~/atari --into pictures)";

void write_class_files(DiscoveryOptions& options) {
  const Images images = images_of(options.images);
  const Cartridge& cartridge = cartridge_of(images, options);
  const Background background = background_of(cartridge, options);
  const ObjectClasses classes = discover_classes(cartridge, options.samples, background);
  const std::string base = write_background(background, cartridge, options);
  replace_file(base + ".classes", bytes_of(classes, background, cartridge, options.samples), Durable::kLater);
  draw_classes(base + "-classes.png", classes);
  draw_objects(base + "-objects.png", background, classes, sample_screen(cartridge, options.samples),
               reach_of(options.samples.play.machine.frame_skip));
  std::size_t shapes = 0;
  for (const ObjectClass& one : classes) shapes += one.size();
  std::printf("%s.classes and its pictures are written: %zu classes of %zu shapes\n", base.c_str(),
              classes.size(), shapes);
}

}  // namespace

void add_classes(Subcommand& program) {
  const auto options = std::make_shared<DiscoveryOptions>();
  SampleSettings& samples = options->samples;
  Subcommand command =
      program.add_subcommand("classes", "Discover the classes of objects in a game", kClassesFooter);
  add_discovery_options(command, *options);
  add_screens_option(command, "--screens", samples.class_screens,
                     "Screens from which the classes are discovered");
  add_screens_option(command, "--background-screens", samples.background_screens,
                     "Screens from which the background is discovered");
  command.runs([options] { write_class_files(*options); });
}

}  // namespace racebeam
