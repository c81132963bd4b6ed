// Text of others, such as the name of a file, for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace racebeam {

// Control characters, which a terminal would obey, and bytes that are no UTF-8 become \xNN, a byte each. All
// other characters stay as they are.
std::string printable(std::string_view text);

}  // namespace racebeam
