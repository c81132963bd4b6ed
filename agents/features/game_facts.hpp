// What is discovered about a game before an agent learns: its background, and its classes of objects. Files
// keep them, so that each is discovered once.
#pragma once

#include <optional>
#include <string>

#include "agents/features/object_classes.hpp"

namespace racebeam {

class GameFacts {
 public:
  // Files lie in `folder`; empty: none are read or written. Processes may share it.
  GameFacts(const Cartridge& cartridge, const SampleSettings& settings, std::string folder)
      : cartridge_(cartridge), settings_(settings), folder_(std::move(folder)) {}

  // Throws InvalidInput for a file of another game, image, seed, source, size or version, and if the file of
  // a background from a CSV file is missing.
  const Background& background();
  const ObjectClasses& classes();

  // Reads the files that are there, and throws as the above. The background of a CSV file must be there.
  void check();

 private:
  template <typename Fact>
  const Fact& kept(std::optional<Fact>& fact, const std::string& ending, const auto& discover,
                   const auto& read, const auto& bytes) const;
  std::string path(const std::string& ending) const;  // of a file of this game
  Background discovered_background() const;

  const Cartridge cartridge_;
  const SampleSettings settings_;
  const std::string folder_;
  std::optional<Background> background_;
  std::optional<ObjectClasses> classes_;
};

// A background as a file: with the image and the samples that it is of.
std::string bytes_of(const Background& background, const Cartridge& cartridge,
                     const SampleSettings& settings);
Background background_of(const std::string& path, const Cartridge& cartridge, const SampleSettings& settings);

// Makes the file of classes, which belong to one background.
std::string bytes_of(const ObjectClasses& classes, const Background& background, const Cartridge& cartridge,
                     const SampleSettings& settings);
ObjectClasses classes_of(const std::string& path, const Background& background, const Cartridge& cartridge,
                         const SampleSettings& settings);

}  // namespace racebeam
