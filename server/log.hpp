// What the server says to the person who started it: one line each, on standard error.
#pragma once

#include <string>

namespace racebeam {

void log(const std::string& sentence);  // "racebeam: sentence", in one piece, from any thread

}  // namespace racebeam
