// What the translator makes of a cartridge goes with its last machine, and making it takes longer than most
// inputs.
#pragma once

#include <vector>

#include "environment/environment.hpp"
#include "games/catalogue.hpp"

namespace racebeam::fuzz {

// All machines of the cartridge share the code, from now on to the end of the process.
inline void keep_code(const Cartridge& cartridge) {
  static std::vector<Environment> machines;
  machines.emplace_back(cartridge.image, cartridge.game, Settings{});
}

}  // namespace racebeam::fuzz
