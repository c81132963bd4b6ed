// Makes untrusted text, such as the name of a file, safe for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace racebeam {

// Replaces control characters, which a terminal would execute, and bytes that are not UTF-8, each by \xNN.
// All other characters stay unchanged.
std::string printable(std::string_view text);

}  // namespace racebeam
