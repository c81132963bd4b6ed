// The program racebeam, with its subcommands.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/help_format.hpp"
#include "cli/arguments/options.hpp"
#include "cli/bench/bench.hpp"
#include "cli/commands/background.hpp"
#include "cli/commands/classes.hpp"
#include "cli/commands/classic.hpp"
#include "cli/commands/config.hpp"
#include "cli/commands/experiment.hpp"
#include "cli/commands/games.hpp"
#include "cli/commands/play.hpp"
#include "cli/commands/png.hpp"
#include "cli/commands/render.hpp"
#include "cli/commands/roms.hpp"
#include "cli/commands/serve.hpp"
#include "cli/commands/trace.hpp"
#include "cli/commands/verify.hpp"
#include "cli/commands/with.hpp"
#include "cli/connect/connect.hpp"
#include "cli/connect/watch.hpp"
#include "system/printable.hpp"
#include "system/program/signals.hpp"
#include "system/program/standard_streams.hpp"
#include "system/similar.hpp"

namespace {

constexpr auto kAbout =
    "A headless Atari 2600 as a server: agents in any language play its games over a pipe or a socket.";

constexpr auto kFooter = R"(Try first:
  racebeam games                 list the games
  racebeam play                  play in a browser
  racebeam serve --stdio         play by hand: type load beamfall, act FIRE, help
  racebeam serve --classic --stdio --rom builtin:beamfall
                                 as ALE 0.4 to 0.6: type 0,0,0,1, then 3,18

Each subcommand has a help text, such as racebeam serve --help.

Exit status:
  0       success
  1       failure, with one line on standard error that gives the reason
  2       usage error; in racebeam verify, also rows that could not be checked
  3 to 5  the start of a server failed (see racebeam serve --help)
  255     a classic client requested an action that does not exist)";

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

// --NAME of each option.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// " did you mean A?", or "".
std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  return racebeam::did_you_mean(word, std::vector<std::string_view>(names.begin(), names.end()));
}

std::string explain_no_subcommand(const CLI::App& app) {
  const auto words = app.remaining();
  const auto commands = subcommand_names(app);
  const std::string names = CLI::detail::join(commands, ", ");
  if (words.empty()) return "a subcommand is required: " + names;
  const std::string similar = suggestion(words.front(), commands);
  return "unknown subcommand '" + words.front() + "';" +
         (similar.empty() ? " accepted: " : similar + " Accepted: ") + names;
}

bool is_option(const std::string& word) { return word.starts_with('-'); }

bool has_unknown_option(const CLI::App& command) {
  return std::ranges::any_of(command.remaining(), is_option);
}

// The words that a subcommand does not take, and what the first option among them may have meant.
std::string explain_extras(const CLI::App& command) {
  const auto words = command.remaining();
  const std::string sentence = "unknown argument: " + CLI::detail::join(words, " ");
  const auto option = std::ranges::find_if(words, is_option);
  if (option == words.end()) return sentence;
  const std::string similar = suggestion(option->substr(0, option->find('=')), option_names(command));
  return similar.empty() ? sentence : sentence + ";" + similar;
}

// Tools from the time of ALE 0.6 call a program of that name.
bool is_called_ale(const std::filesystem::path& called) {
  return called.filename() == "ale" || called.filename() == "racebeam-ale";
}

// The arguments of the command line. When called as ALE, all are arguments of `racebeam classic`. Otherwise,
// `racebeam help serve` is `racebeam serve --help`.
std::vector<const char*> words_of(int argc, char** argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (argc > 0 && is_called_ale(argv[0])) {
    words.insert(words.begin() + 1, "classic");
  } else if (argc > 1 && words[1] == std::string_view("help")) {
    words.erase(words.begin() + 1);
    words.push_back("--help");
  }
  return words;
}

// An error message for the command line, with a pointer to the help text.
std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) return explain_no_subcommand(app) + " (see racebeam --help)";
  const auto is = [&error](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
  // What is missing may be misspelt.
  const bool extras = is(CLI::ExitCodes::ExtrasError) ||
                      (is(CLI::ExitCodes::RequiredError) && has_unknown_option(*chosen[0]));
  const std::string sentence = extras ? explain_extras(*chosen[0]) : std::string(error.what());
  return sentence + " (see racebeam " + chosen[0]->get_name() + " --help)";
}

// In the order of the help text.
constexpr void (*kSubcommands[])(racebeam::Subcommand& program) = {
    racebeam::add_serve,  racebeam::add_connect, racebeam::add_play,       racebeam::add_watch,
    racebeam::add_with,   racebeam::add_config,  racebeam::add_classic,    racebeam::add_trace,
    racebeam::add_bench,  racebeam::add_games,   racebeam::add_roms,       racebeam::add_experiment,
    racebeam::add_verify, racebeam::add_render,  racebeam::add_background, racebeam::add_classes,
    racebeam::add_png,
};

void set_up(CLI::App& app) {
  app.set_version_flag("--version", "racebeam " RACEBEAM_VERSION);
  app.footer(kFooter);
  racebeam::set_help_format(app);
  app.require_subcommand(1);
  app.allow_windows_style_options(false);  // a word that begins with / is a path
  racebeam::Subcommand program(app);
  for (const auto add : kSubcommands) add(program);
}

// Prints the sentence without an allocation. Returns the exit status.
int fail(std::string_view sentence, int status) {
  std::cerr << "racebeam: " << sentence << "\n";
  return status;
}

// Returns the exit status.
int run(int argc, char** argv) {
  CLI::App app{kAbout, "racebeam"};
  set_up(app);
  try {
    const std::vector<const char*> words = words_of(argc, argv);
    app.parse(static_cast<int>(words.size()), words.data());  // executes the subcommand
    return 0;
  } catch (const CLI::RuntimeError& ended) {  // how a subcommand sets the exit status
    return ended.get_exit_code();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(racebeam::printable(explain(app, error)), racebeam::kExitUsage);
  } catch (const std::bad_alloc&) {
    return fail("out of memory: the machine or a limit (ulimit -v) allows no more", racebeam::kExitFailure);
  } catch (const std::exception& error) {
    return fail(racebeam::printable(error.what()), racebeam::kExitFailure);
  }
}

// Output that a full disk has not taken is a failure, also of a command that has succeeded. The C library of
// Windows forgets output that it could not write, and then only ferror() tells.
int after_output(int status) {
  const bool whole = std::cout.flush() && std::ferror(stdout) == 0;
  if (whole || status != 0) return status;
  return fail("cannot write to standard output: its disk is full, or its reader is gone",
              racebeam::kExitFailure);
}

}  // namespace

int main(int argc, char** argv) {
  racebeam::prepare_standard_streams();
  racebeam::ignore_full_files();
  return after_output(run(argc, argv));
}
