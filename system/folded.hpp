// Breaks text for people into lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace racebeam {

// Appends the words of `text`, in lines of at most `columns`, broken at blanks. The first line begins at
// `column`, and the others are indented by `hanging`.
void append_folded(std::string& out, std::string_view text, std::size_t columns, std::size_t column,
                   std::size_t hanging);

}  // namespace racebeam
