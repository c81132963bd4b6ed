#include "games/game.hpp"

#include <algorithm>

namespace racebeam {

bool Game::accepts(const std::string& md5) const {
  return images.empty() || std::any_of(images.begin(), images.end(), [&](const GameImage& image) {
           return image.accepted && (image.md5.empty() || image.md5 == md5);
         });
}

// An entry with the image's own MD5 goes before one that fits any image.
Properties Game::properties_for(const std::string& md5) const {
  for (const std::string& wanted : {md5, std::string{}})
    for (const GameImage& image : images)
      if (image.md5 == wanted) return image.properties;
  return {};
}

Game game_without_rule(const std::string& name) {
  Game game;
  game.name = name;
  game.title = name;
  game.difficulties = {0, 1, 2, 3};
  return game;
}

}  // namespace racebeam
