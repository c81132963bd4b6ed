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
  // Returns the game of an image: that with its MD5, else that with its name. The game of an unknown image
  // has all actions, and no rewards.
  static Game recognise(const Image& image);

  // Returns one of names(). Throws Error for another name.
  static Game named(const std::string& name);

  // Reads a game file of the user. games/catalogue/README.md describes the format. Throws Error, which names
  // the file, the line and the field.
  static Game load(const std::string& path);

  // The names of the games that the library knows, in alphabetical order.
  static std::vector<std::string> names();

  const std::string& name() const noexcept;   // as in names(), such as "beamfall"
  const std::string& title() const noexcept;  // for people

  // Whether the game has a rule. Without one, rewards and lives are 0, and no episode is terminated.
  bool has_rewards() const noexcept;

  // Whether the game's rule was written for this image. If not, rewards and ends may be wrong.
  bool fits(const Image& image) const;

  std::vector<Action> legal_actions() const;    // in the order of their numbers
  std::vector<Action> minimal_actions() const;  // those of them that have an effect

  std::vector<int> modes() const;  // ascending; Environment::set_mode()
  int default_mode() const noexcept;

  // Positions of the difficulty switches, ascending; Environment::set_difficulty(). Bit 0 is set if the left
  // switch is at A, bit 1 if the right one is. An environment begins with 0: both at B.
  std::vector<int> difficulties() const;

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
