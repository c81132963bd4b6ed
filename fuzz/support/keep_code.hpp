// Translated code of a cartridge is released with its last machine, and translating takes longer than most
// inputs.
#pragma once

#include <vector>

#include "environment/environment.hpp"
#include "games/catalogue.hpp"

namespace racebeam::fuzz {

// All machines of the cartridge share its code, from now until the process ends.
inline void keep_code(const Cartridge& cartridge) {
  static std::vector<Environment> machines;
  machines.emplace_back(cartridge.image, cartridge.game, Settings{});
}

}  // namespace racebeam::fuzz
