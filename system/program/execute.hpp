// Not available on Windows.
#pragma once

#include <string>
#include <vector>

namespace racebeam {

// Runs a program in the place of this one. words: the program, which is searched for in the PATH, and its
// arguments. Returns only if that fails, and then returns the reason, a value of errno.
int execute(const std::vector<std::string>& words);

}  // namespace racebeam
