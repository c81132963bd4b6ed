// The cartridge images that clients may load: by name or MD5, never by path. A server reads them once, when
// it starts; they are const afterwards, and shared by all sessions.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "games/catalogue.hpp"

namespace racebeam {

class Images {
 public:
  Images();  // those that are part of the program

  // Both throw InvalidInput if the path cannot be read, or no cartridge scheme fits the image. Such files of
  // a folder are left out. game, game_file: the rule, as for recognise(). own: for recognise_among().
  void add_file(const std::string& path, const std::optional<std::string>& game = std::nullopt,
                const std::optional<std::string>& game_file = std::nullopt,
                const PropertyOverrides& console = {});
  void add_folder(const std::string& folder, const std::vector<std::shared_ptr<const Game>>& own = {});
  // Gives the images that are part of the program to the user's games, as recognise_among() does.
  void add_built_in(const std::vector<std::shared_ptr<const Game>>& own);

  // Adds an image that is found by its MD5 only. It replaces the one with this MD5. own: its game; null: the
  // catalogue decides. Returns what find() returns. Throws InvalidInput if no cartridge scheme fits the
  // image.
  const Cartridge& put(const std::shared_ptr<const Image>& image, const std::shared_ptr<const Game>& own);

  // name: a game of the catalogue, the stem of an unknown image's file, or an MD5. Returns null if there is
  // no such image.
  const Cartridge* find(std::string_view name) const;
  // Returns the stored image with the bytes of `image`; null if no image has them.
  std::shared_ptr<const Image> same(const Image& image) const;
  std::vector<std::string_view> names() const;  // without the MD5s
  // A game of the catalogue, or of an available image. Null for an unknown game, and for one without a rule.
  std::shared_ptr<const Game> rules(std::string_view game) const;
  std::vector<std::string> warnings() const;  // a warning for each image that another image's rule scores

 private:
  void add(const std::shared_ptr<const Image>& image, const Recognition& recognition,
           const PropertyOverrides& console);

  struct Entry {
    Cartridge cartridge;
    int certainty;  // of the recognition; among images with one key, the most certain is offered
  };
  std::map<std::string, Entry, std::less<>> by_name_, by_md5_;
};

}  // namespace racebeam
