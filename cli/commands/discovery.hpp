// What `racebeam background` and `racebeam classes` share: options, and the background's file.
#pragma once

#include <string>

#include "agents/features/game_facts.hpp"
#include "cli/arguments/image_options.hpp"

namespace racebeam {

class Subcommand;

struct DiscoveryOptions {
  DiscoveryOptions();  // samples as those of an experiment

  std::string game, into, csv;
  SampleSettings samples;
  ImageOptions images;
};

// `options` must outlive the parsing.
void add_discovery_options(Subcommand& command, DiscoveryOptions& options);

// Adds an option for a number of screens.
void add_screens_option(Subcommand& command, const std::string& name, int& screens, const std::string& help);

// The image of the game. Throws InvalidInput if it is missing.
const Cartridge& cartridge_of(const Images& images, const DiscoveryOptions& options);

// Reads --csv, whose digest the samples then have, or discovers the background. Throws InvalidInput.
Background background_of(const Cartridge& cartridge, DiscoveryOptions& options);

// Makes the folder and writes GAME.background. Returns FOLDER/GAME, the beginning of the files' paths.
std::string write_background(const Background& background, const Cartridge& cartridge,
                             const DiscoveryOptions& options);

}  // namespace racebeam
