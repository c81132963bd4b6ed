// Cartridges of random code, one for each scheme; they access everything, in random order.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "games/game/game.hpp"
#include "games/rom_image.hpp"

namespace racebeam::test {

// The schemes with random images: all that have code to run.
std::span<const std::string_view> random_schemes();

// Returns the same image for the same seed, on every machine. The scheme cannot be detected from its bytes,
// and must be selected. Throws std::invalid_argument for another scheme.
std::shared_ptr<const Image> random_image(std::string_view scheme, unsigned seed);

// A game without a rule that selects `scheme` for any image.
std::shared_ptr<const Game> random_game(std::string_view scheme);

}  // namespace racebeam::test
