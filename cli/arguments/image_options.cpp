#include "cli/arguments/image_options.hpp"

#include "cli/arguments/options.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

constexpr int kMostThreads = 1024;

}  // namespace

void add_image_options(CLI::App& app, ImageOptions& options) {
  app.add_option("--roms", options.folders,
                 "A folder with cartridge images; may be repeated. Without it, the games that are built in")
      ->allow_extra_args(false)
      ->envname("RACEBEAM_ROMS");
  app.add_option("--threads", options.threads, "Threads that play; 0: one for each processor")
      ->check(whole_number(0, kMostThreads))
      ->capture_default_str();
  add_cpu_option(app, options.cpu);
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
