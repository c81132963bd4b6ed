// A game: its actions and modes, and the rule that turns memory into rewards and lives. A Game never changes
// and its copies share their data, so any number of threads may use one.
//
//     const auto image = racebeam::Image::load("builtin:beamfall");
//     const auto game = racebeam::Game::recognise(image);
//     std::cout << game.title() << " has " << game.minimal_actions().size() << " actions:";
//     for (const auto action : game.minimal_actions()) std::cout << ' ' << racebeam::name_of(action);
//     std::cout << "\nand is one of " << racebeam::Game::names().size() << " known games\n";
//     return game.has_rewards() && game.fits(image) ? 0 : 1;
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "racebeam/action.hpp"
#include "racebeam/config.hpp"
#include "racebeam/image.hpp"

namespace RACEBEAM_NAMESPACE {

class RACEBEAM_API Game {
 public:
  // The game of an image, by its MD5, else by its name. The game of an unknown image has all actions, and no
  // rewards.
  static Game recognise(const Image& image);

  static Game named(const std::string& name);  // one of names(); throws Error for others

  // Reads a game file of the user. games/catalogue/README.md describes the format. Throws Error, which names
  // the file, the line and the field.
  static Game load(const std::string& path);

  static std::vector<std::string> names();  // the games that the library knows, ascending

  const std::string& name() const noexcept;   // as in names()
  const std::string& title() const noexcept;  // for people

  bool has_rewards() const noexcept;
  // Whether the game's rule was written for this image. If not, rewards and ends may be wrong.
  bool fits(const Image& image) const;

  std::vector<Action> legal_actions() const;    // in the order of their numbers
  std::vector<Action> minimal_actions() const;  // those of them that have an effect

  std::vector<int> modes() const;  // ascending, as are the difficulties
  int default_mode() const noexcept;
  std::vector<int> difficulties() const;  // an environment begins with 0

 private:
  friend struct Internals;
  struct Impl;
  explicit Game(std::shared_ptr<const Impl> impl);

  std::shared_ptr<const Impl> impl_;
};

// An image, and the game that it is played as.
struct Cartridge {
  Image image;
  Game game;
};

}  // namespace RACEBEAM_NAMESPACE
