// Lines that a person types, or that come from a pipe.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace racebeam {

class LineEditor {
 public:
  // On a terminal, lines can be edited, earlier ones are recalled, also those of earlier sessions, and the
  // tabulator completes a line's first word to one of `words`. Elsewhere, there is no prompt.
  LineEditor(std::string prompt, std::vector<std::string> words);
  ~LineEditor();  // writes the history
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;

  // The next line, without its end; nothing at the end of the input.
  std::optional<std::string> next();

  // Whether a person types.
  bool interactive() const { return interactive_; }

 private:
  std::string prompt_;
  bool interactive_;
};

}  // namespace racebeam
