#include "games/game/game.hpp"

#include <algorithm>
#include <set>
#include <string_view>

namespace racebeam {
namespace {

// Dumps whose two banks are in the wrong order, whatever their file name (docs/spec/cartridges.md, 1).
constexpr std::string_view kSwappedImages[] = {"bc24440b59092559a1ec26055fd1270e",
                                               "75ee371ccfc4f43e7d9b8f24e1266b55"};

// An entry with the image's own MD5 is preferred to one that fits any image.
Properties entry_for(const Game& game, const std::string& md5) {
  for (const std::string& key : {md5, std::string{}})
    for (const GameImage& image : game.images)
      if (image.md5 == key) return image.properties;
  return {};
}

}  // namespace

bool Game::accepts(const std::string& md5) const {
  return images.empty() || std::any_of(images.begin(), images.end(), [&](const GameImage& image) {
           return image.accepted && (image.md5.empty() || image.md5 == md5);
         });
}

Properties Game::properties_for(const std::string& md5) const {
  Properties properties = entry_for(*this, md5);
  const bool is_swapped = std::ranges::find(kSwappedImages, md5) != std::end(kSwappedImages);
  if (is_swapped && properties.scheme.empty()) properties.scheme = "F8 swapped";
  return properties;
}

std::vector<int> Game::offered_modes() const {
  std::set<int> offered(modes.begin(), modes.end());
  offered.insert(two_player_modes.begin(), two_player_modes.end());
  return {offered.begin(), offered.end()};
}

Game game_without_rule(const std::string& name) {
  Game game;
  game.name = name;
  game.title = name;
  game.difficulties = {0, 1, 2, 3};
  return game;
}

}  // namespace racebeam
