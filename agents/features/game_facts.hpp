// What is discovered about a game before an agent learns: its background. Files keep it, so that each is
// discovered once.
#pragma once

#include <optional>
#include <string>

#include "agents/features/background.hpp"

namespace racebeam {

class GameFacts {
 public:
  // Files lie in `folder`; empty: none are read or written. Processes may share it.
  GameFacts(const Cartridge& cartridge, const SampleSettings& settings, std::string folder)
      : cartridge_(cartridge), settings_(settings), folder_(std::move(folder)) {}

  // Throws InvalidInput for a file of another game, image, seed, size or version.
  const Background& background();

 private:
  std::string path(const std::string& ending) const;

  const Cartridge cartridge_;
  const SampleSettings settings_;
  const std::string folder_;
  std::optional<Background> background_;
};

// A background as a file: with the image and the samples that it is of.
std::string bytes_of(const Background& background, const Cartridge& cartridge,
                     const SampleSettings& settings);
Background background_of(const std::string& path, const Cartridge& cartridge, const SampleSettings& settings);

}  // namespace racebeam
