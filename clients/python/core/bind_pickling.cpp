// Pickling of ALEInterface: the settings now and as the image was loaded, and the image with its game and
// state, if one is loaded.
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include "clients/python/core/ale_interface.hpp"
#include "clients/python/core/bindings.hpp"
#include "clients/python/core/gil.hpp"

namespace racebeam::python {
namespace {

using KeysAsTables =
    std::tuple<Keys::Table<int>, Keys::Table<bool>, Keys::Table<float>, Keys::Table<std::string>>;
using Loaded = std::tuple<KeysAsTables, std::string, nb::bytes, std::string, nb::bytes>;

// Keys that another version did not pickle keep their defaults.
template <class Value>
void take(Keys::Table<Value>& keys, Keys::Table<Value> pickled) {
  pickled.merge(keys);
  keys = std::move(pickled);
}

KeysAsTables as_tables(const Keys& keys) { return {keys.ints, keys.bools, keys.floats, keys.strings}; }

Keys as_keys(const KeysAsTables& tables) {
  Keys keys;
  take(keys.ints, std::get<0>(tables));
  take(keys.bools, std::get<1>(tables));
  take(keys.floats, std::get<2>(tables));
  take(keys.strings, std::get<3>(tables));
  return keys;
}

nb::bytes as_bytes(const std::string& text) { return nb::bytes(text.data(), text.size()); }

// The state of an interface at one moment.
struct Moment {
  Keys keys, keys_of_machine;
  std::shared_ptr<const Image> image;  // null: no image is loaded
  std::string game;
  AleState state;
};

Moment moment_of(AleInterface& self) {
  const Turn turn(self.lock());
  if (!self.is_loaded()) return {self.keys(), self.keys(), nullptr, "", {}};
  const Environment& environment = self.environment();
  return {self.keys(), self.keys_of_machine(), std::make_shared<const Image>(environment.image()),
          environment.game().name, AleState(self.machine(), true)};
}

std::tuple<KeysAsTables, std::optional<Loaded>> pickled(AleInterface& self) {
  const Moment now = moment_of(self);
  if (!now.image) return {as_tables(now.keys), std::nullopt};
  const std::span<const std::uint8_t> image = now.image->file();
  return {as_tables(now.keys),
          Loaded{as_tables(now.keys_of_machine), now.image->stem, nb::bytes(image.data(), image.size()),
                 now.game, as_bytes(now.state.serialize())}};
}

void unpickle(AleInterface& self, const std::tuple<KeysAsTables, std::optional<Loaded>>& pickle) {
  new (&self) AleInterface;
  const auto& [keys, loaded] = pickle;
  if (loaded) {
    const auto& [keys_of_machine, stem, image, game, state] = *loaded;
    self.keys() = as_keys(keys_of_machine);
    const auto* const begin = static_cast<const std::uint8_t*>(image.data());
    self.load(make_image({begin, begin + image.size()}, stem),
              find_game(game) ? std::optional(game) : std::nullopt);
    AleState(std::string(state.c_str(), state.size())).restore_in(self.environment());
  }
  self.keys() = as_keys(keys);
}

}  // namespace

void bind_pickling(nb::class_<AleInterface>& interface) {
  interface.def("__getstate__", pickled).def("__setstate__", unpickle);
}

}  // namespace racebeam::python
