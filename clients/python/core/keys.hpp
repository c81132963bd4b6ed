// The settings of ALE by their keys (docs/spec/environment.md, 14). All take effect when an image is loaded.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "environment/settings.hpp"
#include "games/game/property_overrides.hpp"

namespace racebeam::python {

struct Keys {
  template <class Value>
  using Table = std::map<std::string, Value, std::less<>>;

  Keys();  // the reference's defaults

  Table<int> ints;
  Table<bool> bools;
  Table<float> floats;
  Table<std::string> strings;

  // Throws InvalidInput for a value that no environment accepts. A seed of -1 is replaced by one from the
  // clock.
  Settings settings() const;

  // The properties of the console that the keys give for the image; -1 and "" mean that a key is not given.
  // Throws InvalidInput, too.
  PropertyOverrides console() const;
};

}  // namespace racebeam::python
