#include "agents/features/game_facts.hpp"

#include <algorithm>
#include <filesystem>

#include "agents/base/file_lock.hpp"
#include "agents/base/sealed_file.hpp"
#include "recording/atomic_file.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr SealedKind kBackground = {
    .what = "background", .magic = "RBBACKGR", .version = 1, .most = std::size_t{1} << 20, .level = 9};

// The first line of a file.
std::string source_of(const Cartridge& cartridge, const SampleSettings& settings, int screens) {
  return "game=" + cartridge.game->name + " image=" + cartridge.image->md5 +
         " seed=" + std::to_string(settings.seed) + " screens=" + std::to_string(screens) +
         " frame_skip=" + std::to_string(settings.play.machine.frame_skip) +
         " color_averaging=" + std::to_string(settings.play.machine.color_averaging);
}

// The contents behind the first line, which must be `source`.
std::string_view behind(std::string_view contents, const std::string& source, const std::string& path) {
  const std::string_view found = contents.substr(0, contents.find('\n'));
  if (found != source)
    throw InvalidInput(path + " is of '" + std::string(found) + "'; wanted is '" + source + "'");
  return contents.substr(found.size() + 1);
}

}  // namespace

std::string bytes_of(const Background& background, const Cartridge& cartridge,
                     const SampleSettings& settings) {
  return seal(kBackground, (source_of(cartridge, settings, settings.background_screens) += '\n')
                               .append(background.begin(), background.end()));
}

Background background_of(const std::string& path, const Cartridge& cartridge,
                         const SampleSettings& settings) {
  const std::string contents = read_sealed(kBackground, path);
  const std::string_view pixels =
      behind(contents, source_of(cartridge, settings, settings.background_screens), path);
  Background background;
  if (pixels.size() != background.size() || std::ranges::any_of(pixels, [](char byte) { return byte < 0; }))
    throw InvalidInput(path + " does not hold 160 x 210 colours from 0 to 127");
  std::ranges::copy(pixels, background.begin());
  return background;
}

std::string GameFacts::path(const std::string& ending) const {
  return folder_ + '/' + cartridge_.game->name + ending;
}

const Background& GameFacts::background() {
  if (background_) return *background_;
  if (folder_.empty()) return background_.emplace(discover_background(cartridge_, settings_));
  const FileLock lock(path(".lock"));
  const std::string file = path(".background");
  if (std::filesystem::exists(file)) return background_.emplace(background_of(file, cartridge_, settings_));
  background_ = discover_background(cartridge_, settings_);
  replace_file(file, bytes_of(*background_, cartridge_, settings_), Durable::kNow);
  return *background_;
}

}  // namespace racebeam
