#include "cli/arguments/own_games.hpp"

#include <algorithm>
#include <filesystem>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

// Whether recognise_among() finds this game for its image.
bool is_here(const Game& game, const Images& images) {
  const Cartridge* const found = images.find(game.name);
  if (found == nullptr) return false;
  const Image& image = *found->image;
  return image.stem == game.name ||
         std::ranges::find(game.images, image.md5, &GameImage::md5) != game.images.end();
}

}  // namespace

OwnGames::OwnGames(const std::string& path) : path_(path) {
  if (path.empty()) return;
  if (std::filesystem::is_directory(path))
    games_ = load_game_folder(path);
  else
    games_ = {load_game_file(path)};
}

void OwnGames::check_use(const Images& images, const std::string& places) const {
  const auto here = [&](const auto& game) { return is_here(*game, images); };
  if (games_.empty() || std::ranges::any_of(games_, here)) return;
  throw InvalidInput("--game-file " + path_ +
                     ": no image has an MD5 that it lists, or is named like it, in " + places);
}

}  // namespace racebeam
