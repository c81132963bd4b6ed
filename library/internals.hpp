// The internals of the public classes of include/racebeam/. Here they are v0::Environment, v0::Game and so
// on, and racebeam::Environment is the class that they stand for.
#pragma once

#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "environment/settings.hpp"
#include "environment/vector/slot.hpp"
#include "games/catalogue.hpp"
#include "racebeam/error.hpp"
#include "racebeam/game.hpp"
#include "racebeam/image.hpp"
#include "racebeam/settings.hpp"
#include "racebeam/snapshot.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::v0 {

struct Image::Impl {
  std::shared_ptr<const racebeam::Image> image;
};

struct Game::Impl {
  std::shared_ptr<const racebeam::Game> game;
};

// Either a saved state with what is needed to draw it, or bytes that restore() will read.
struct Snapshot::Impl {
  racebeam::Cartridge cartridge{};
  racebeam::Settings settings{};
  Slot::Saved saved{};
  bool is_of_slot = false;
  std::vector<std::uint8_t> bytes{};  // where `saved` has no machine
};

// Opens the public classes to the rest of the library.
struct Internals {
  static Image wrap(std::shared_ptr<const racebeam::Image> image) {
    return Image(std::make_shared<const Image::Impl>(Image::Impl{std::move(image)}));
  }
  static Game wrap(std::shared_ptr<const racebeam::Game> game) {
    return Game(std::make_shared<const Game::Impl>(Game::Impl{std::move(game)}));
  }
  // is_of_slot: it contains more than the machine; an Environment saves only the machine.
  static Snapshot wrap(const racebeam::Cartridge& cartridge, const racebeam::Settings& settings,
                       Slot::Saved saved, bool is_of_slot) {
    return Snapshot(std::make_shared<const Snapshot::Impl>(
        Snapshot::Impl{cartridge, settings, std::move(saved), is_of_slot, {}}));
  }

  static const std::shared_ptr<const racebeam::Image>& of(const Image& image) { return image.impl_->image; }
  static const std::shared_ptr<const racebeam::Game>& of(const Game& game) { return game.impl_->game; }

  // The state of a snapshot, which `environment` can restore. Throws InvalidInput if it cannot.
  static Slot::Saved saved(const Snapshot& snapshot, const racebeam::Environment& environment);

  // The image with what the game says about its console.
  static racebeam::Cartridge cartridge(const Image& image, const Game& game) {
    return {of(image), recognise_as(*of(image), of(game)).game};
  }
};

racebeam::Settings internal(const Settings& settings);

// Runs `work`. Exceptions of the internal classes become an Error with this cause.
template <class Work>
decltype(auto) guarded(Error::Cause cause, Work&& work) {
  try {
    return work();
  } catch (const InvalidInput& error) {
    throw Error(cause, error.what());
  } catch (const std::system_error& error) {  // executable memory or a thread is not available
    throw Error(cause, error.what());
  }
}

// `sentence` is a function, so that a call without an error makes no text.
template <class Sentence>
void require(bool good, const Sentence& sentence) {
  if (!good) throw Error(Error::Cause::kArgument, sentence());
}

}  // namespace racebeam::v0
