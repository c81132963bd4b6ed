// The options of subcommands that play many games: where their images are, and how many threads play.
#pragma once

#include <string>
#include <vector>

#include "emulator/translator/translator.hpp"
#include "games/images.hpp"

namespace racebeam {

class Subcommand;

struct ImageOptions {
  std::vector<std::string> folders;
  std::string game_file;  // the user's games: a file, or a folder of files
  unsigned threads = 0;   // 0: one for each processor that the process may use
  CpuKind cpu = CpuKind::kAuto;
};

// Adds --roms --game-file --threads --cpu. `options` must outlive the parsing.
void add_image_options(Subcommand& command, ImageOptions& options);

Images images_of(const ImageOptions& options);  // throws InvalidInput, also if no image is of --game-file
unsigned threads_of(const ImageOptions& options);

}  // namespace racebeam
