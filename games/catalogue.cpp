#include "games/catalogue.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <utility>

#include "emulator/cartridge/cartridge.hpp"
#include "games/files/game_file.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/similar.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kMaxGameFile = 1 << 20;

// The built-in image of a game is recognised by its MD5, which the game file need not list.
std::shared_ptr<const Game> parsed(std::size_t number) {
  const CatalogueEntry& entry = catalogue()[number];
  Game game = parse_game(entry.text, std::string(entry.name), std::string(entry.name) + ".toml");
  return std::make_shared<const Game>(std::move(game));
}

const CatalogueImage* known_image(std::string_view md5) {
  const auto images = catalogue_images();
  const auto found = std::ranges::lower_bound(images, md5, {}, &CatalogueImage::md5);
  return found != images.end() && found->md5 == md5 ? &*found : nullptr;
}

[[noreturn]] void refuse_name(const std::string& name) {
  const std::string near = did_you_mean(name, game_names());
  throw InvalidInput("unknown game '" + name + "';" + (near.empty() ? " `racebeam games` lists all" : near));
}

bool describes(const Game& game, const Image& image) {
  return std::ranges::any_of(game.images,
                             [&](const GameImage& one) { return one.md5.empty() || one.md5 == image.md5; });
}

Game with_image(Game game, const GameImage& image) {
  const auto same = std::ranges::find(game.images, image.md5, &GameImage::md5);
  same != game.images.end() ? void(*same = image) : game.images.push_back(image);
  for (std::shared_ptr<const Game>* const variant : {&game.fixed, &game.classic})
    if (*variant) *variant = std::make_shared<const Game>(with_image(**variant, image));
  return game;
}

// The properties of a game's first image, for another dump of it.
Properties properties_of_dump(const Game& game, const Image& image) {
  Properties properties = game.images.front().properties;
  if (!properties.scheme.empty() && image.bytes->size() < scheme_named(properties.scheme).least_image)
    properties.scheme = {};
  return properties;
}

// What the console is told about an image goes before the rule that scores it (docs/spec/console.md). An
// image that no game lists is taken for another dump of `game`.
std::shared_ptr<const Game> with_properties_of(const Image& image, std::shared_ptr<const Game> game) {
  if (describes(*game, image)) return game;
  const CatalogueImage* const entry = known_image(image.md5);
  if (entry == nullptr && game->images.empty()) return game;
  const Properties properties =
      entry ? parsed(entry->entry)->properties_for(image.md5) : properties_of_dump(*game, image);
  return std::make_shared<const Game>(with_image(*game, {image.md5, properties, false}));
}

Recognition recognition_of(const std::shared_ptr<const Game>& game, RecognisedBy how, const Image& image) {
  return {with_properties_of(image, game), how, game->accepts(image.md5)};
}

// Words of the line protocol that cannot be names: `load inline`, `games all`, an MD5.
bool is_taken(std::string_view name) {
  constexpr std::size_t kDigitsOfMd5 = 32;
  return name == "inline" || name == "all" ||
         (name.size() == kDigitsOfMd5 &&
          name.find_first_not_of("0123456789abcdef") == std::string_view::npos);
}

// Makes a word that the line protocol can use in lists.
std::string as_name(std::string text) {
  const auto stays = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
  };
  std::ranges::replace_if(text, std::not_fn(stays), '_');
  return is_taken(text) ? text + '_' : text;
}

// The image is of no known game. It may be another dump of one, which needs the same controllers.
Recognition unknown(const Image& image) {
  auto game = std::make_shared<const Game>(game_without_rule(as_name(image.stem)));
  return {with_properties_of(image, std::move(game)), RecognisedBy::kNothing, true};
}

std::string stem_of(const std::string& path) {
  return lower_case(std::filesystem::path(path).stem().string());
}

}  // namespace

std::shared_ptr<const Game> find_game(std::string_view name) {
  const auto games = catalogue();
  const auto found = std::ranges::lower_bound(games, name, {}, &CatalogueEntry::name);
  if (found == games.end() || found->name != name) return nullptr;
  return parsed(static_cast<std::size_t>(found - games.begin()));
}

std::shared_ptr<const Game> find_game_by_md5(std::string_view md5) {
  const CatalogueImage* entry = known_image(md5);
  return entry && entry->accepted ? parsed(entry->entry) : nullptr;
}

std::vector<std::string_view> game_names() {
  std::vector<std::string_view> names;
  for (const CatalogueEntry& entry : catalogue()) names.push_back(entry.name);
  return names;
}

std::shared_ptr<const Game> game_in_file(std::string_view text, const std::string& path) {
  return std::make_shared<const Game>(parse_game(text, as_name(stem_of(path)), path));
}

std::shared_ptr<const Game> load_game_file(const std::string& path) {
  return game_in_file(read_input_file("game file", path, kMaxGameFile), path);
}

std::vector<std::shared_ptr<const Game>> load_game_folder(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  if (files.empty()) throw InvalidInput(folder + ": this folder has no game files; their names end in .toml");
  std::ranges::sort(files);
  std::vector<std::shared_ptr<const Game>> games;
  std::ranges::transform(files, std::back_inserter(games), load_game_file);
  return games;
}

Recognition recognise_among(const Image& image, const std::vector<std::shared_ptr<const Game>>& own) {
  const auto lists_it = [&](const auto& game) {
    return std::ranges::find(game->images, image.md5, &GameImage::md5) != game->images.end();
  };
  auto found = std::ranges::find_if(own, lists_it);
  if (found == own.end())
    found = std::ranges::find(own, image.stem, [](const auto& game) { return game->name; });
  return found != own.end() ? recognition_of(*found, RecognisedBy::kGivenFile, image) : recognise(image);
}

Recognition recognise(const Image& image, const std::optional<std::string>& game_name,
                      const std::optional<std::string>& game_file) {
  if (game_name && game_file) throw InvalidInput("give the name of a game or a game file, not both");
  if (game_file && std::filesystem::is_directory(*game_file))
    return recognise_among(image, load_game_folder(*game_file));
  if (game_file) return recognition_of(load_game_file(*game_file), RecognisedBy::kGivenFile, image);
  if (game_name) {
    auto game = find_game(*game_name);
    if (!game) refuse_name(*game_name);
    return recognise_as(image, game);
  }
  if (auto game = find_game_by_md5(image.md5)) return {std::move(game), RecognisedBy::kMd5, true};
  if (auto game = find_game(image.stem)) return recognition_of(game, RecognisedBy::kFileName, image);
  return unknown(image);
}

Recognition recognise_as(const Image& image, const std::shared_ptr<const Game>& game) {
  return recognition_of(game, RecognisedBy::kGivenName, image);
}

std::shared_ptr<const Game> with_overrides(std::shared_ptr<const Game> game, const Image& image,
                                           const PropertyOverrides& overrides) {
  if (overrides.empty()) return game;
  const Properties properties = overrides.apply_to(game->properties_for(image.md5));
  return std::make_shared<const Game>(with_image(*game, {image.md5, properties, game->accepts(image.md5)}));
}

bool is_other_dump(const Game& game, const Image& image) {
  const bool lists_images = std::ranges::any_of(game.images, &GameImage::accepted);
  return game.has_rule() && lists_images && !game.accepts(image.md5);
}

bool is_doubtful(const Game& game, const Image& image) {
  if (!game.properties_for(image.md5).scheme.empty() || known_image(image.md5) != nullptr) return false;
  return accesses_no_hot_spot(*image.bytes, scheme_of(*image.bytes));
}

std::string image_warning(const Game& game, const Image& image) {
  if (is_other_dump(game, image))
    return "the MD5 of this image, " + image.md5 + ", is not that of the image which the rule of '" +
           game.name + "' was written for; score and end may be wrong";
  if (!is_doubtful(game, image)) return "";
  return "no code of this image selects a bank of the cartridge scheme " +
         std::string(scheme_of(*image.bytes).name) +
         ", which its size suggests; it may not run. The setting scheme names another one";
}

}  // namespace racebeam
