// The replies of `help`, for people.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace racebeam {

// A reply of `help`, which is one line, in lines of at most `columns`: what it lists has a line for each, and
// longer ones are folded.
std::string help_lines(std::string_view reply, std::size_t columns);

std::size_t columns_of_output();  // of the terminal that standard output is, else 80

}  // namespace racebeam
