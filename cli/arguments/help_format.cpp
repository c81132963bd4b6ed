#include "cli/arguments/help_format.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "system/folded.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kHelpColumn = 30;  // where the texts of options begin

// Wraps paragraphs. Lines that begin with a blank, such as examples and tables, stay as they are.
std::string wrapped_paragraphs(const std::string& text) {
  std::string result, paragraph;
  const auto end_paragraph = [&] {
    if (paragraph.empty()) return;
    append_folded(result, paragraph, kWidth, 0, 0);
    result += '\n';
    paragraph.clear();
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != ' ') {
      paragraph += line + ' ';
      continue;
    }
    end_paragraph();
    result += line + '\n';
  }
  end_paragraph();
  return result;
}

class HelpFormat : public CLI::Formatter {
 public:
  HelpFormat() { column_width(kHelpColumn); }

  // Without the second of the two empty lines that CLI11 leaves between groups.
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, std::move(name), mode), "\n\n\n",
                                         "\n\n");
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    std::string lines;
    append_folded(lines, option->get_description(), kWidth - kHelpColumn, 0, 0);
    return lines;
  }

  std::string make_footer(const CLI::App* app) const override {
    return wrapped_paragraphs(app->get_footer());
  }
};

}  // namespace

void set_help_format(CLI::App& app) { app.formatter(std::make_shared<HelpFormat>()); }

}  // namespace racebeam
