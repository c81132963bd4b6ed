// Cartridges full of random code, one for each scheme: they touch everything, in no order.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "games/image.hpp"

namespace racebeam::test {

// The schemes that there are random images of.
std::span<const std::string_view> random_schemes();

// The same seed gives the same image, on every machine. Throws std::invalid_argument for another scheme.
std::shared_ptr<const Image> random_image(std::string_view scheme, unsigned seed);

}  // namespace racebeam::test
