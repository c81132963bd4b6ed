// Lines that a person types, or that come from a pipe.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

class LineEditor {
 public:
  // The words that may stand where `word` begins, after `before` in the same line.
  using Complete = std::function<std::vector<std::string>(std::string_view before, std::string_view word)>;

  // On a terminal, lines can be edited, earlier ones are recalled, also those of earlier sessions, and the
  // Tab key completes words. Elsewhere, it shows no prompt.
  LineEditor(std::string prompt, Complete complete);
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
