// Cartridges full of random code, one for each scheme: they touch everything, in no order.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "games/game/game.hpp"
#include "games/rom_image.hpp"

namespace racebeam::test {

// The schemes that there are random images of: all that have code to run.
std::span<const std::string_view> random_schemes();

// The same seed gives the same image, on every machine. Its bytes don't tell the scheme: it has to be asked for.
// Throws std::invalid_argument for another scheme.
std::shared_ptr<const Image> random_image(std::string_view scheme, unsigned seed);

// A game without a rule that asks for `scheme`, whatever the image.
std::shared_ptr<const Game> random_game(std::string_view scheme);

}  // namespace racebeam::test
