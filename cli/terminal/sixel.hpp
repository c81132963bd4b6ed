// A picture as sixels: DEC's form of pictures for terminals, six pixels a character, one above the other.
#pragma once

#include <string>

#include "cli/terminal/picture.hpp"

namespace racebeam {

// At the cursor. As large as whole multiples of the pixels fit into the room, a pixel twice as wide as high.
std::string sixel(const TerminalPicture& picture, const Room& room);

}  // namespace racebeam
