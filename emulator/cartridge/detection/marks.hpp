// Evidence for an image's scheme besides its size and the reference's signatures: texts, and code that
// accesses hot spots (docs/spec/cartridges.md, 2).
#pragma once

#include <string_view>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam {

// The scheme that a text in the image names; empty if no text does.
std::string_view scheme_by_text(const Rom& rom);

// The scheme whose hot spots the image's code accesses; empty if it accesses none.
std::string_view scheme_by_accesses(const Rom& rom);

// Whether the image has code of an ARM: many returns of Thumb functions.
bool has_arm_code(const Rom& rom);

}  // namespace racebeam
