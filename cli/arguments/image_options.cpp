#include "cli/arguments/image_options.hpp"

#include "cli/arguments/options.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

constexpr int kMostThreads = 1024;

}  // namespace

void add_image_options(Subcommand& command, ImageOptions& options) {
  command
      .option("--roms", options.folders,
              "A folder with cartridge images; may be repeated. Without it, the games that are built in")
      .one_a_time()
      .variable("RACEBEAM_ROMS");
  command.option("--threads", options.threads, "Threads that play; 0: one for each processor")
      .check(whole_number(0, kMostThreads))
      .shows_default();
  add_cpu_option(command, options.cpu);
}

Images images_of(const ImageOptions& options) {
  Images images;
  for (const std::string& folder : options.folders) images.add_folder(folder);
  return images;
}

unsigned threads_of(const ImageOptions& options) {
  return options.threads > 0 ? options.threads : static_cast<unsigned>(usable_processors().amount);
}

}  // namespace racebeam
