// 0840 and 4A50. The reference knows their names, but maps no memory: the cartridge reads 0 everywhere.
#pragma once

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::unmapped {

inline void reset(CartridgeSlot&) {}
inline void map(CartridgeSlot& slot) { slot.map.hide(0, 4096); }

}  // namespace racebeam::unmapped
