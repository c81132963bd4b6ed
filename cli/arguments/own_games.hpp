// The user's game files (--game-file), for commands that offer many images.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "games/catalogue.hpp"
#include "games/images.hpp"

namespace racebeam {

class OwnGames {
 public:
  // A game file, or a folder of them; an empty path: none. Throws InvalidInput.
  explicit OwnGames(const std::string& path);

  const std::vector<std::shared_ptr<const Game>>& games() const { return games_; }

  // Throws InvalidInput if none of these games is that of an available image: the file would have no
  // effect. `places`: where the images are from.
  void check_use(const Images& images, const std::string& places) const;

 private:
  std::string path_;
  std::vector<std::shared_ptr<const Game>> games_;
};

}  // namespace racebeam
