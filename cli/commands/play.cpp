#include "cli/commands/play.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "cli/arguments/own_games.hpp"
#include "cli/commands/serve.hpp"
#include "cli/commands/serve_options.hpp"
#include "cli/connect/browser.hpp"
#include "cli/connect/page_address.hpp"
#include "cli/connect/player.hpp"
#include "games/catalogue.hpp"
#include "system/program/private_folder.hpp"
#include "system/program/standard_streams.hpp"
#include "system/program/supervisor.hpp"
#include "system/similar.hpp"

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

With --terminal, draws the game in the terminal, without sound; without GAME, it is Beamfall. Keys: the arrows and Space
are player A, W A S D and G are player B, p pauses, n begins a new game, q quits. Many terminals do not tell when a key
is released: a key then counts as pressed for 0.2 s, and again with each repetition. Pictures that the line does not
carry in time are left out. The server's log is shown at the end.

Examples:
  racebeam play
  racebeam play pong --roms ~/atari
  racebeam play --terminal beamfall)";

constexpr auto kUsualGame = "beamfall";

struct PlayCommand {
  ServeOptions serve;
  std::string game;
  bool terminal = false;
  Graphics graphics = Graphics::kAuto;
};

// Options of racebeam serve that play refuses, and does not show.
constexpr std::array kServeOnly = {"--stdio", "--pipes", "--ready-file", "--announce", "--classic"};

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

void check_game(const std::string& name, const ServeOptions& options) {
  const Images images = offered_images(options);
  if (images.find(name) != nullptr) return;
  const auto names = game_names();
  if (std::ranges::find(names, name) != names.end())
    throw UsageError("GAME: no image of " + name +
                     " was found in these places: " + places_of_images(options));
  throw UsageError("GAME: unknown game '" + name + "';" + did_you_mean(name, names) +
                   " racebeam games lists them");
}

// The game to begin with: GAME, else that of --rom, else that of --game-file, else an empty text.
std::string first_game(const PlayCommand& options) {
  const MachineOptions& machine = options.serve.machine;
  if (!options.game.empty()) {
    check_game(options.game, options.serve);
    return options.game;
  }
  if (!machine.rom.empty()) return open_cartridge(machine, [](const std::string&) {}).game->name;
  const OwnGames own(machine.game_file.value_or(""));
  if (own.games().size() != 1) return {};
  own.check_use(offered_images(options.serve), places_of_images(options.serve));
  return own.games().front()->name;
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

void show_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (file.peek() != std::ifstream::traits_type::eof()) std::cerr << file.rdbuf();
}

int play_in_browser(PlayCommand& options, const std::vector<Setting>& settings) {
  Supervisor supervisor;
  const PrivateFolder folder;
  ServeOptions& serve = options.serve;
  serve.server.announce = folder.path() / "announce";
  if (serve.addresses.empty()) serve.addresses = {"ws://127.0.0.1:0"};
  if (supervisor.fork_server()) return run_server(serve, settings);
  if (const int status = supervisor.wait_until_ready(serve.server.announce); status != 0) return status;
  const std::string page = page_of(serve.server.announce, options.game);
  std::cout << page << std::endl;
  if (const auto command = browser_command(page)) supervisor.start(*command);
  return supervisor.wait();
}

int play_here(PlayCommand& options, const std::vector<Setting>& settings) {
  if (!is_terminal(kStandardInput) || !is_terminal(kStandardOutput))
    throw UsageError("--terminal: standard input and output must be a terminal");
  Supervisor supervisor;
  const PrivateFolder folder;
  const std::filesystem::path log = folder.path() / "log";  // messages would be drawn over by pictures
  ServeOptions& serve = options.serve;
  serve.server.announce = folder.path() / "announce";
  const std::string address = "unix:" + (folder.path() / "socket").string();
  serve.addresses.push_back(address);
  if (supervisor.fork_server(log)) return run_server(serve, settings);
  int status = supervisor.wait_until_ready(serve.server.announce);
  if (status == 0) {
    if (supervisor.fork_command()) {
      play_in_terminal(address, options.game.empty() ? kUsualGame : options.game, options.graphics);
      return 0;
    }
    status = supervisor.wait_for_command();
    supervisor.stop_server();
  }
  show_file(log);
  return status;
}

int run(PlayCommand& options, const std::vector<Setting>& settings) {
  check_for_page(options.serve);
  options.game = first_game(options);
  if (is_default(settings, "log_level")) options.serve.log_level = LogLevel::kWarning;
  return options.terminal ? play_here(options, settings) : play_in_browser(options, settings);
}

}  // namespace

void add_play(Subcommand& program) {
  Subcommand command =
      program.add_subcommand("play", "Play in a browser or in the terminal, on this machine", kPlayFooter);
  const auto options = std::make_shared<PlayCommand>();
  add_serve_options(command, options->serve);
  command.option("GAME", options->game, "The game to begin with");
  command.flag("--terminal", options->terminal, "Play in the terminal");
  add_graphics_option(command, options->graphics);
  for (const char* name : kServeOnly) command.find(name).group("");
  group_classic_options(command, "");
  command.exits_with([options, command] { return run(*options, complete(command)); });
}

}  // namespace racebeam
