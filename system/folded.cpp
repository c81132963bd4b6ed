#include "system/folded.hpp"

#include <algorithm>

namespace racebeam {

void append_folded(std::string& out, std::string_view text, std::size_t columns, std::size_t column,
                   std::size_t hanging) {
  for (bool first = true; !text.empty();) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(word.size());
    if (word.empty()) continue;
    if (!first) {
      const bool fits = column + 1 + word.size() <= columns;
      fits ? out += ' ' : (out += '\n').append(hanging, ' ');
      column = fits ? column + 1 : hanging;
    }
    first = false;
    out += word;
    column += word.size();
  }
}

}  // namespace racebeam
