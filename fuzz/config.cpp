// A file of settings for `racebeam serve --config`. If it is accepted, `racebeam config` prints it, and that
// output must have the same meaning.
#include "cli/commands/config.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>
#include <sstream>

#include "cli/arguments/subcommand.hpp"
#include "fuzz/support/memory_file.hpp"
#include "fuzz/support/target.hpp"

namespace racebeam::fuzz {
namespace {

class CapturedOutput {
 public:
  CapturedOutput() : before_(std::cout.rdbuf(text_.rdbuf())) {}
  ~CapturedOutput() { std::cout.rdbuf(before_); }
  CapturedOutput(const CapturedOutput&) = delete;
  CapturedOutput& operator=(const CapturedOutput&) = delete;

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf* before_;
};

// The output of `racebeam config` for the file; nothing if the file is refused.
std::optional<std::string> printed(std::string_view file) {
  const MemoryFile config(file);
  const CapturedOutput output;
  CLI::App app;
  Subcommand program(app);
  add_config(program);
  try {
    // CLI11 expects them in reverse order
    app.parse(std::vector<std::string>{config.path(), "--config", "config"});
  } catch (const CLI::Error& error) {
    require(*error.what() != '\0', "an error has a message");
    return std::nullopt;
  }
  return output.text();
}

// The settings without their sources.
std::string settings_in(const std::string& text) {
  std::istringstream lines(text);
  std::string settings;
  for (std::string line; std::getline(lines, line);) {
    line.resize(line.rfind("  # "));
    line.resize(line.find_last_not_of(' ') + 1);
    settings += line + "\n";
  }
  return settings;
}

}  // namespace

void run(Bytes input) {
  const auto first = printed(text_of(input));
  if (!first) return;
  const auto second = printed(*first);
  require(second.has_value(), "what `racebeam config` prints is accepted", *first);
  require(settings_in(*first) == settings_in(*second), "what `racebeam config` prints has the same meaning",
          *first + *second);
}

}  // namespace racebeam::fuzz
