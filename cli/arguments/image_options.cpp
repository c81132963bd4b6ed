#include "cli/arguments/image_options.hpp"

#include "cli/arguments/options.hpp"
#include "cli/arguments/own_games.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

constexpr int kMaxThreads = 1024;

}  // namespace

void add_image_options(Subcommand& command, ImageOptions& options) {
  command
      .option("--roms", options.folders,
              "A folder with cartridge images; may be repeated. Without it, the games that are built in")
      .value_name("DIR")
      .one_a_time()
      .variable("RACEBEAM_ROMS");
  command
      .option("--game-file", options.game_file,
              "A game file, or a folder of game files, with rules for images of --roms or built-in ones")
      .value_name("FILE");
  command.option("--threads", options.threads, "Threads that play; 0: one for each processor")
      .check(whole_number(0, kMaxThreads))
      .shows_default();
  add_cpu_option(command, options.cpu);
}

Images images_of(const ImageOptions& options) {
  Images images;
  const OwnGames own(options.game_file);
  std::string places = "the program's own games";
  for (const std::string& folder : options.folders) {
    images.add_folder(folder, own.games());
    places += ", --roms " + folder;
  }
  images.add_built_in(own.games());
  own.check_use(images, places);
  return images;
}

unsigned threads_of(const ImageOptions& options) {
  return options.threads > 0 ? options.threads : static_cast<unsigned>(usable_processors().amount);
}

}  // namespace racebeam
