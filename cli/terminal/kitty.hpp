// A picture in the graphics protocol of the terminal kitty, which other terminals have, too.
#pragma once

#include <string>

#include "cli/terminal/picture.hpp"

namespace racebeam {

// At the cursor, as large as the room admits with the proportions of a television. in_place: the cursor stays
// where it is, and the picture replaces the last one of this kind.
std::string kitty_picture(const TerminalPicture& picture, const Room& room, bool in_place);

}  // namespace racebeam
