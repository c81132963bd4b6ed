#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "clients/python/core/bindings.hpp"
#include "clients/python/core/gil.hpp"
#include "clients/python/core/image_argument.hpp"
#include "games/catalogue.hpp"

namespace racebeam::python {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

using Row = std::tuple<std::string_view, std::string_view, bool, bool>;

std::vector<Row> rows() {
  std::vector<Row> rows;
  for (const CatalogueEntry& game : catalogue())
    rows.emplace_back(game.name, game.title, game.has_rule, game.built_in);
  return rows;
}

std::vector<std::string_view> md5s_of(const std::string& name) {
  std::vector<std::string_view> md5s;
  for (const CatalogueImage& image : catalogue_images())
    if (image.accepted && catalogue()[image.entry].name == name) md5s.push_back(image.md5);
  return md5s;
}

std::tuple<std::string, std::optional<std::string>> identify(const ImageArgument& where) {
  const auto image = image_of(where, "bytes");
  const auto game = find_game_by_md5(image->md5);
  return {image->md5, game ? std::optional(game->name) : std::nullopt};
}

}  // namespace

void bind_catalogue(nb::module_& module) {
  module.def(
      "games", rows,
      "Lists the games: name, title, whether the game has a score, and whether its image is built in.");
  module.def("md5s", md5s_of, "game"_a, "Returns the MD5s of the images of a game.");
  module.def("identify", identify, "image"_a, nb::call_guard<WithoutGil>(),
             nb::sig("def identify(image: str | os.PathLike[str] | bytes) -> tuple[str, str | None]"),
             "The MD5 of an image, a path or its bytes, and the game that it is; None for a game that is not "
             "known.");
  module.def("image_files", image_files, "folder"_a, nb::call_guard<WithoutGil>(),
             "Lists the files of a folder whose names end like those of images.");
}

}  // namespace racebeam::python
