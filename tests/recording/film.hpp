// A machine to record, and its recording.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "environment/environment.hpp"
#include "games/catalogue.hpp"
#include "recording/media.hpp"

namespace racebeam::test {

inline Environment beamfall() {
  Settings settings;
  settings.random_seed = 1;
  settings.sticky = 0;
  const auto image = load_image("builtin:beamfall");
  return {image, recognise(*image).game, settings};
}

inline std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::size_t files_in(const std::string& folder) {
  const std::filesystem::directory_iterator files(folder);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

}  // namespace racebeam::test
