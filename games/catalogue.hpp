// The games that are part of the program, and the recognition of images.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "games/game/game.hpp"
#include "games/game/property_overrides.hpp"
#include "games/rom_image.hpp"

namespace racebeam {

// A built-in game file. `text` is parsed when the game is first used.
struct CatalogueEntry {
  std::string_view name;
  std::string_view title;
  bool has_rule;
  bool built_in;  // its image is part of the program, as builtin:NAME
  std::string_view text;
};

// An image's MD5, with the number of its game in catalogue().
struct CatalogueImage {
  std::string_view md5;
  std::size_t entry;
  bool accepted;  // see GameImage
};

std::span<const CatalogueEntry> catalogue();         // in order of names
std::span<const CatalogueImage> catalogue_images();  // in order of MD5s

std::shared_ptr<const Game> find_game(std::string_view name);        // null if unknown
std::shared_ptr<const Game> find_game_by_md5(std::string_view md5);  // only accepted images; null if unknown

std::vector<std::string_view> game_names();  // of catalogue(), in its order

// Loads a game file of the user. Throws InvalidInput: "FILE:LINE: FIELD: sentence".
std::shared_ptr<const Game> load_game_file(const std::string& path);

// Parses the contents of a game file, as load_game_file() does. path: names the file in errors, and the game.
std::shared_ptr<const Game> game_in_file(std::string_view text, const std::string& path);

// Loads all files of a folder that end in .toml. Throws InvalidInput for the first wrong one, and for a
// folder without such files.
std::vector<std::shared_ptr<const Game>> load_game_folder(const std::string& folder);

enum class RecognisedBy { kMd5, kGivenName, kGivenFile, kFileName, kNothing };

struct Recognition {
  std::shared_ptr<const Game> game;  // never null; without a rule if the image is unknown
  RecognisedBy how = RecognisedBy::kNothing;
  bool md5_matches = true;  // false: the game's rule was written for another image; the caller should warn
};

// Returns the game of an image: the one that the caller names or whose file it gives. Otherwise the MD5
// decides, and then the name of the image's file. If game_file is a folder, recognise_among() searches it.
// Throws InvalidInput for an unknown name (with suggestions) or an invalid file.
Recognition recognise(const Image& image, const std::optional<std::string>& game_name = std::nullopt,
                      const std::optional<std::string>& game_file = std::nullopt);

// Returns the game of `own`, the user's games, that lists the image's MD5; otherwise the one of them that is
// named like the image; otherwise what recognise() returns.
Recognition recognise_among(const Image& image, const std::vector<std::shared_ptr<const Game>>& own);

// Returns the recognition of an image whose game the caller knows.
Recognition recognise_as(const Image& image, const std::shared_ptr<const Game>& game);

// Returns the game with these overrides for the console of this image. Throws InvalidInput if the picture
// does not fit.
std::shared_ptr<const Game> with_overrides(std::shared_ptr<const Game> game, const Image& image,
                                           const PropertyOverrides& overrides);

// Whether a game's rule was written for another image than this one.
bool is_other_dump(const Game& game, const Image& image);

// Whether the image probably does not have the cartridge scheme that its size suggests, while nothing else
// determines its scheme.
bool is_doubtful(const Game& game, const Image& image);

// A warning for the user about another dump, or a doubtful image; empty for other images.
std::string image_warning(const Game& game, const Image& image);

// An image and its game. Both are const, so that any number of machines share them.
struct Cartridge {
  std::shared_ptr<const Image> image;
  std::shared_ptr<const Game> game;
};

}  // namespace racebeam
