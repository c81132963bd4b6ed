#include "cli/connect/line_editor.hpp"

#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>

#include "system/program/standard_streams.hpp"

#ifdef RACEBEAM_LIBEDIT
#include <editline/readline.h>
#endif

namespace racebeam {

#ifdef RACEBEAM_LIBEDIT
namespace {

constexpr int kMaxHistory = 1000;  // lines

// libedit has one state for the program, and its callbacks have no argument of ours.
struct Completions {
  LineEditor::Complete complete;
  std::vector<std::string> words;  // that are offered
};
Completions& completions() {
  static Completions all;
  return all;
}

// Called until it returns null: the next word, in memory that libedit frees.
char* next_word(const char*, int state) {
  static std::size_t next = 0;
  if (state == 0) next = 0;
  const auto& words = completions().words;
  return next < words.size() ? ::strdup(words[next++].c_str()) : nullptr;
}

// No exception may pass through libedit. What cannot be completed stays as it is.
char** complete_word(const char* text, int begin, int) {
  ::rl_attempted_completion_over = 1;  // no file names
  auto& [complete, words] = completions();
  try {
    words = complete(std::string_view(::rl_line_buffer).substr(0, static_cast<std::size_t>(begin)), text);
  } catch (const std::exception&) {
    words.clear();
  }
  const bool goes_on = words.size() == 1 && (words[0].ends_with('=') || words[0].ends_with(':'));
  ::rl_completion_append_character = static_cast<unsigned char>(goes_on ? '\0' : ' ');
  return ::rl_completion_matches(text, next_word);
}

// The file of the history (XDG base directories); empty if no folder of the user is known. A relative path
// would lead to whatever folder the program was started in.
std::filesystem::path history_file() {
  const auto folder = [](const char* variable) {
    const char* const path = std::getenv(variable);
    return std::filesystem::path(path != nullptr && *path == '/' ? path : "");
  };
  if (const auto state = folder("XDG_STATE_HOME"); !state.empty()) return state / "racebeam_history";
  const auto home = folder("HOME");
  return home.empty() ? home : home / ".local/state/racebeam_history";
}

}  // namespace

LineEditor::LineEditor(std::string prompt, Complete complete)
    : prompt_(std::move(prompt)), interactive_(is_terminal(kStandardInput) && is_terminal(kStandardOutput)) {
  if (!interactive_) return;
  static char blank[] = " ";  // libedit's type has no const
  completions().complete = std::move(complete);
  ::rl_basic_word_break_characters = ::rl_completer_word_break_characters = blank;
  ::rl_attempted_completion_function = complete_word;
  ::using_history();
  ::stifle_history(kMaxHistory);
  ::read_history(history_file().c_str());
}

LineEditor::~LineEditor() {
  if (!interactive_) return;
  completions().complete = nullptr;
  if (history_file().empty()) return;
  std::error_code ignored;  // without a history, everything else works
  std::filesystem::create_directories(history_file().parent_path(), ignored);
  ::write_history(history_file().c_str());
}

std::optional<std::string> LineEditor::next() {
  std::string line;
  if (!interactive_) return std::getline(std::cin, line) ? std::optional(line) : std::nullopt;
  const std::unique_ptr<char, decltype(&std::free)> typed(::readline(prompt_.c_str()), &std::free);
  if (!typed) return std::nullopt;
  line = typed.get();
  if (!line.empty()) ::add_history(line.c_str());
  return line;
}
#else
LineEditor::LineEditor(std::string prompt, Complete)
    : prompt_(std::move(prompt)), interactive_(is_terminal(kStandardInput) && is_terminal(kStandardOutput)) {}

LineEditor::~LineEditor() = default;

std::optional<std::string> LineEditor::next() {
  if (interactive_) std::cout << prompt_ << std::flush;
  std::string line;
  return std::getline(std::cin, line) ? std::optional(line) : std::nullopt;
}
#endif

}  // namespace racebeam
