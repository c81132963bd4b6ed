#include "cli/commands/play.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "cli/commands/serve.hpp"
#include "cli/commands/serve_options.hpp"
#include "cli/commands/supervisor.hpp"
#include "cli/connect/browser.hpp"
#include "cli/connect/page_address.hpp"
#include "games/catalogue.hpp"
#include "games/similar.hpp"

namespace racebeam {
namespace {

constexpr auto kPlayFooter =
    R"(Starts a server that only this machine can reach, prints the address of its page, and opens it in a browser where
there is a desktop. Ctrl-C ends the server.

The address contains a token, which the server makes anew at each start: other users of the machine cannot play.
The options are those of racebeam serve, except for --stdio, --pipes, --ready-file, --announce and --classic. The log
has warnings and errors, unless --log-level says otherwise.

To play on another machine, start racebeam play there, with --listen ws://127.0.0.1:7800, and forward the port:
  ssh -L 7800:127.0.0.1:7800 HOST racebeam play --listen ws://127.0.0.1:7800
Then open the address that it prints, here.

Examples:
  racebeam play
  racebeam play pong --roms ~/atari)";

void check_for_page(const ServeOptions& options) {
  const auto refuse = [](const std::string& option) {
    throw UsageError(option + ": requires racebeam serve");
  };
  if (options.standard_streams) refuse("--stdio");
  if (!options.pipes.empty()) refuse("--pipes");
  if (!options.server.ready_file.empty()) refuse("--ready-file");
  if (!options.server.announce.empty()) refuse("--announce");
  if (options.classic) refuse("--classic");
}

void check_game(const std::string& name) {
  const auto names = game_names();
  if (name.empty() || std::ranges::find(names, name) != names.end()) return;
  throw UsageError("GAME: there is no game '" + name + "';" + did_you_mean(name, names) +
                   " racebeam games lists them");
}

// The address of the page, with the token in the part that a browser does not send.
std::string page_of(const std::filesystem::path& announce, const std::string& game) {
  std::string token, page = announced_page(announce, token);
  if (page.empty())
    throw std::invalid_argument("racebeam play needs an address ws://HOST:PORT or wss://HOST:PORT");
  page += '/';
  if (!game.empty()) page.append("?game=").append(game);
  return page.append("#token=").append(token);
}

int run(ServeOptions& options, const std::vector<Setting>& settings, const std::string& game) {
  check_for_page(options);
  check_game(game);
  Supervisor supervisor;
  const PrivateFolder folder;
  options.server.announce = folder.path() / "announce";
  if (options.addresses.empty()) options.addresses = {"ws://127.0.0.1:0"};
  if (is_default(settings, "log_level")) options.log_level = LogLevel::kWarning;
  if (supervisor.fork_server()) return run_server(options, settings);
  if (const int status = supervisor.wait_until_ready(options.server.announce); status != 0) return status;
  const std::string page = page_of(options.server.announce, game);
  std::cout << page << std::endl;
  if (const auto command = browser_command(page)) supervisor.start(*command);
  return supervisor.wait();
}

}  // namespace

void add_play(Subcommand& program) {
  Subcommand command = program.add_subcommand("play", "Play in a browser, on this machine", kPlayFooter);
  const auto options = std::make_shared<ServeOptions>();
  const auto game = std::make_shared<std::string>();
  add_serve_options(command, *options);
  command.option("GAME", *game, "The game that the page begins with");
  command.exits_with([options, game, command] { return run(*options, complete(command), *game); });
}

}  // namespace racebeam
