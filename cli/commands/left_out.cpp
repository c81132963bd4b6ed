// The subcommands that Windows lacks. Their names stay known, so that each says what to do instead.
#include <memory>
#include <string>
#include <vector>

#include "cli/arguments/options.hpp"
#include "cli/commands/play.hpp"
#include "cli/commands/with.hpp"
#include "cli/connect/connect.hpp"
#include "cli/connect/watch.hpp"

namespace racebeam {
namespace {

void leave_out(Subcommand& program, const std::string& name, const std::string& instead) {
  Subcommand command = program.add_subcommand(name, "Not on Windows: " + instead, "");
  const auto words = std::make_shared<std::vector<std::string>>();
  command.option("WORDS", *words, "What it takes on other systems");
  command.takes_all_words();
  command.exits_with(
      [name, instead, words]() -> int { throw UsageError(name + ": not on Windows; accepted: " + instead); });
}

}  // namespace

void add_connect(Subcommand& program) {
  leave_out(program, "connect", "racebeam serve --stdio, to type requests, or a client of clients/");
}
void add_play(Subcommand& program) {
  leave_out(program, "play", "racebeam serve --listen ws://127.0.0.1:PORT, whose page a browser opens");
}
void add_watch(Subcommand& program) {
  leave_out(program, "watch", "the page of racebeam serve --listen ws://127.0.0.1:PORT, in a browser");
}
void add_with(Subcommand& program) {
  leave_out(program, "with", "racebeam serve, and the command with its address in RACEBEAM_ADDRESS");
}

}  // namespace racebeam
