#include "cli/commands/with.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "cli/commands/serve.hpp"
#include "cli/commands/serve_options.hpp"
#include "system/program/private_folder.hpp"
#include "system/program/sockets.hpp"
#include "system/program/supervisor.hpp"

namespace racebeam {
namespace {

constexpr auto kWithFooter =
    R"(Starts a server, waits until it accepts connections, and runs COMMAND with the variable RACEBEAM_ADDRESS, which
all clients of clients/ and of the Python package read. When COMMAND ends, the server stops. Nothing is left
behind: the server's socket and its announce file lie in their own folder, below TMPDIR or /tmp.

The options before -- are those of racebeam serve, except for --stdio, --pipes, --ready-file and --announce.
Without an address, the server listens on a Unix socket and on a port of 127.0.0.1. Over TCP, clients need the
token of the announce file. The log has warnings and errors, unless --log-level says otherwise.

Signals: SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2 and SIGINT are passed on to COMMAND. If racebeam with is killed,
COMMAND and the server get SIGTERM.

Exit status: that of COMMAND, or one of these:
  126          COMMAND cannot be executed
  127          COMMAND is not found
  128 + N      signal N has ended COMMAND
  1 to 5       usage error, or the server does not start (see racebeam serve --help)

Examples:
  racebeam with -- python3 agent.py
  racebeam with --roms ~/atari --threads 2 -- ./play pong)";

void refuse(const std::string& option, const std::string& why) { throw UsageError(option + ": " + why); }

void check_for_command(const ServeOptions& options) {
  if (options.standard_streams || !options.pipes.empty())
    refuse(options.standard_streams ? "--stdio" : "--pipes",
           "requires racebeam serve; COMMAND needs a socket");
  if (!options.server.announce.empty() || !options.server.ready_file.empty())
    refuse(options.server.announce.empty() ? "--ready-file" : "--announce",
           "requires racebeam serve; COMMAND has the address in RACEBEAM_ADDRESS");
}

std::vector<std::string> usual_addresses(const PrivateFolder& folder) {
  std::vector<std::string> addresses{"tcp://127.0.0.1:0"};
  const std::string socket = folder.path() / "socket";
  if (socket.size() <= longest_socket_path()) addresses.insert(addresses.begin(), "unix:" + socket);
  return addresses;
}

int run(ServeOptions& options, const std::vector<Setting>& settings, const std::vector<std::string>& words) {
  check_for_command(options);
  Supervisor supervisor;
  const PrivateFolder folder;
  options.server.announce = folder.path() / "announce";
  if (options.addresses.empty()) options.addresses = usual_addresses(folder);
  if (is_default(settings, "log_level")) options.log_level = LogLevel::kWarning;
  if (supervisor.fork_server()) return run_server(options, settings);
  if (const int status = supervisor.wait_until_ready(options.server.announce); status != 0) return status;
  ::setenv("RACEBEAM_ADDRESS", ("file:" + options.server.announce).c_str(), 1);
  const int status = supervisor.run(words);
  supervisor.stop_server();
  return status;
}

}  // namespace

void add_with(Subcommand& program) {
  Subcommand command = program.add_subcommand("with", "Run a command with its own server", kWithFooter);
  const auto options = std::make_shared<ServeOptions>();
  const auto words = std::make_shared<std::vector<std::string>>();
  add_serve_options(command, *options);
  command.option("COMMAND", *words, "The command and its arguments, after --").required();
  command.exits_with([options, words, command] { return run(*options, complete(command), *words); });
}

}  // namespace racebeam
