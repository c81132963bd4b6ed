#include "games/images.hpp"

#include <stdexcept>
#include <utility>

#include "emulator/cartridge/cartridge.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

// What the user says about an image goes before its MD5, and that before the name of its file.
int certainty_of(RecognisedBy how) {
  switch (how) {
    case RecognisedBy::kGivenName:
    case RecognisedBy::kGivenFile: return 2;
    case RecognisedBy::kMd5: return 1;
    default: return 0;
  }
}

}  // namespace

Images::Images() { add_built_in({}); }

void Images::add_built_in(const std::vector<std::shared_ptr<const Game>>& own) {
  for (const BuiltInImage& one : builtin_images()) {
    auto image = load_image("builtin:" + std::string(one.name));
    const Recognition recognition = recognise_among(*image, own);
    add(image, recognition, {});
  }
}

void Images::add_file(const std::string& path, const std::optional<std::string>& game,
                      const std::optional<std::string>& game_file, const PropertyOverrides& console) {
  const auto image = load_image(path);
  const Recognition recognition = recognise(*image, game, game_file);
  add(image, recognition, console);
}

void Images::add_folder(const std::string& folder, const std::vector<std::shared_ptr<const Game>>& own) {
  for (const std::string& path : image_files(folder)) {
    try {
      const auto image = load_image(path);
      const Recognition recognition = recognise_among(*image, own);
      add(image, recognition, {});
    } catch (const InvalidInput&) {
      continue;  // `racebeam roms` reports the error
    }
  }
}

void Images::add(const std::shared_ptr<const Image>& image, const Recognition& recognition,
                 const PropertyOverrides& console) {
  const int certainty = certainty_of(recognition.how);
  const Cartridge cartridge{image, with_overrides(recognition.game, *image, console)};
  scheme_of(*image->bytes, cartridge.game->properties_for(image->md5).scheme);  // throws
  const auto put = [&](auto& map, const std::string& key) {
    const auto [place, is_new] = map.try_emplace(key, Entry{cartridge, certainty});
    if (!is_new && certainty > place->second.certainty) place->second = {cartridge, certainty};
  };
  put(by_name_, cartridge.game->name);
  put(by_md5_, image->md5);
}

const Cartridge& Images::put(const std::shared_ptr<const Image>& image,
                             const std::shared_ptr<const Game>& own) {
  const Recognition recognition = own ? recognise_as(*image, own) : recognise(*image);
  scheme_of(*image->bytes, recognition.game->properties_for(image->md5).scheme);  // throws
  const Entry entry{{image, recognition.game}, certainty_of(recognition.how)};
  return by_md5_.insert_or_assign(image->md5, entry).first->second.cartridge;
}

const Cartridge* Images::find(std::string_view name) const {
  for (const auto* map : {&by_name_, &by_md5_}) {
    if (const auto found = map->find(name); found != map->end()) return &found->second.cartridge;
  }
  return nullptr;
}

std::shared_ptr<const Image> Images::same(const Image& image) const {
  const auto found = by_md5_.find(image.md5);
  const bool is_same = found != by_md5_.end() && *found->second.cartridge.image->bytes == *image.bytes;
  return is_same ? found->second.cartridge.image : nullptr;
}

std::vector<std::string_view> Images::names() const {
  std::vector<std::string_view> all;
  for (const auto& [name, entry] : by_name_) all.push_back(name);
  return all;
}

std::shared_ptr<const Game> Images::rules(std::string_view game) const {
  if (auto row = find_game(game)) return row;
  const auto found = by_name_.find(game);
  if (found == by_name_.end() || !found->second.cartridge.game->has_rule()) return nullptr;
  return found->second.cartridge.game;
}

std::vector<std::string> Images::warnings() const {
  std::vector<std::string> all;
  for (const auto& [md5, entry] : by_md5_) {
    std::string warning = image_warning(*entry.cartridge.game, *entry.cartridge.image);
    if (!warning.empty()) all.push_back(std::move(warning));
  }
  return all;
}

}  // namespace racebeam
