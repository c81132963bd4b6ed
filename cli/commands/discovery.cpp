#include "cli/commands/discovery.hpp"

#include <cstdio>
#include <filesystem>
#include <limits>

#include "cli/arguments/options.hpp"
#include "recording/atomic_file.hpp"
#include "recording/sha256.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/similar.hpp"

namespace racebeam {
namespace {

constexpr int kMaxScreens = 10000000;
constexpr std::size_t kMaxCsvBytes = std::size_t{1} << 20;

}  // namespace

DiscoveryOptions::DiscoveryOptions() {
  samples.play.machine.frame_skip = 5;
  samples.version = RACEBEAM_VERSION;
}

void add_discovery_options(Subcommand& command, DiscoveryOptions& options) {
  command.option("GAME", options.game, "The game, by its name").required();
  command.option("--into", options.into, "The folder of the files that are written")
      .value_name("DIR")
      .required();
  command.option("--csv", options.csv, "Take the background from this file: 210 lines of 160 colours")
      .value_name("FILE");
  command.option("--seed", options.samples.seed, "Seed of the random play")
      .check(whole_number(0, std::numeric_limits<std::uint32_t>::max()))
      .shows_default();
  add_image_options(command, options.images);
}

void add_screens_option(Subcommand& command, const std::string& name, int& screens, const std::string& help) {
  command.option(name, screens, help).check(whole_number(1, kMaxScreens)).shows_default();
}

const Cartridge& cartridge_of(const Images& images, const DiscoveryOptions& options) {
  if (const Cartridge* const cartridge = images.find(options.game)) return *cartridge;
  if (!find_game(options.game))
    throw InvalidInput("unknown game '" + options.game + "';" + did_you_mean(options.game, game_names()) +
                       " racebeam games lists them");
  throw InvalidInput("no image was found for '" + options.game + "'; --roms names the folder that holds it");
}

Background background_of(const Cartridge& cartridge, DiscoveryOptions& options) {
  if (options.csv.empty()) return discover_background(cartridge, options.samples);
  const std::string text = read_input_file("background", options.csv, kMaxCsvBytes);
  options.samples.background_csv = sha256_of(text);
  return background_of_csv(options.csv, text);
}

std::string write_background(const Background& background, const Cartridge& cartridge,
                             const DiscoveryOptions& options) {
  std::filesystem::create_directories(options.into);
  const std::string base = options.into + '/' + cartridge.game->name;
  replace_file(base + ".background", bytes_of(background, cartridge, options.samples), Durable::kLater);
  if (const std::string& digest = options.samples.background_csv; !digest.empty())
    std::printf("a plan takes this background with [backgrounds] and %s = \"%s\"\n",
                cartridge.game->name.c_str(), digest.c_str());
  return base;
}

}  // namespace racebeam
