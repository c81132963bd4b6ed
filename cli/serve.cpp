#include "cli/serve.hpp"

#include <memory>
#include <vector>

#include "cli/options.hpp"
#include "server/address.hpp"
#include "server/sockets.hpp"
#include "server/streams.hpp"

namespace racebeam {
namespace {

constexpr auto kFooter = R"(The server speaks first, then waits: nothing moves until the client asks.

--classic is the text protocol of ALE 0.4 to 0.6 (protocol/CLASSIC.md): the server says 160-210; the client
answers with four flags, 1,1,0,1 for screen, RAM and reward; from then on it sends actions, 3,18, and gets a
line for each.

Examples:
  racebeam serve --classic --stdio --rom tetris.bin --seed 1
      one session on standard input and output; try printf '0,0,0,1\n3,18\n' | racebeam serve ...
  racebeam serve --classic --pipes /run/user/1000/tetris --rom tetris.bin
      one session over the named pipes tetris_out and tetris_in; open tetris_out first, for reading
  racebeam serve --classic --listen tcp://127.0.0.1:0 --listen unix:tetris.sock --rom tetris.bin
      until it is told to stop (SIGTERM), a machine of its own for everyone who connects

With --classic one generator serves the machine and what is random in play, as it did then: --system-seed is
not used. The seed of each session is in the log, on standard error.

Standard output carries the protocol and nothing else. Exit status: 0 the session ended, or SIGTERM or SIGINT
came; 1 the start failed, or the client of --stdio or --pipes stopped reading or sent what makes no sense;
2 the command line makes no sense; 255 that client asked for an action that does not exist.)";

struct ServeOptions {
  MachineOptions machine;
  ClassicOptions protocol;
  bool classic = false, standard_streams = false, full_screen = false;
  std::string pipes;
  std::vector<std::string> addresses;
};

std::string check_address(const std::string& text) {
  try {
    parse_address(text);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

void check(const ServeOptions& options) {
  if (!options.classic) {
    throw CLI::ValidationError("serve",
                               "--classic is missing; the classic protocol is the only one built so far");
  }
  const int transports = options.standard_streams + !options.pipes.empty() + !options.addresses.empty();
  if (transports != 1) {
    throw CLI::ValidationError("serve", "give one of --stdio, --pipes PREFIX and --listen ADDRESS");
  }
}

ClassicService make_service(const ServeOptions& options) {
  const auto power_on_one = [options, cartridge = open_cartridge(options.machine)] {
    MachineOptions machine = options.machine;
    machine.settings.random_seed = resolve_seed(machine.settings.random_seed);
    return power_on(cartridge, machine);
  };
  return {power_on_one, options.protocol};
}

int serve(ServeOptions& options) {
  check(options);
  options.protocol.run_length = !options.full_screen;
  options.machine.settings.classic = true;
  const ClassicService service = make_service(options);
  if (options.standard_streams) return serve_standard_streams(service);
  if (!options.pipes.empty()) return serve_pipes(options.pipes, service);
  return serve_sockets(options.addresses, service);
}

}  // namespace

void add_serve(CLI::App& app) {
  CLI::App* command = app.add_subcommand("serve", "Serve a game to agents, over a pipe or a socket");
  command->footer(kFooter);
  const auto options = std::make_shared<ServeOptions>();
  command->add_flag("--classic", options->classic, "Speak the text protocol of ALE 0.4 to 0.6");
  command->add_flag("--stdio", options->standard_streams, "One session on standard input and output");
  command
      ->add_option("--pipes", options->pipes,
                   "One session on the named pipes PREFIX_out and PREFIX_in, made if missing")
      ->type_name("PREFIX");
  command
      ->add_option("--listen", options->addresses,
                   "Sessions on tcp://127.0.0.1:PORT (0 picks one) or unix:PATH; repeatable")
      ->type_name("ADDRESS")
      ->check(CLI::Validator(check_address, ""))
      ->allow_extra_args(false);
  add_machine_options(*command, options->machine);
  add_count(*command, "--max-episode-frames", options->machine.settings.max_episode_frames, 0,
            "Frames after which an episode is cut short; 0: no limit");
  add_count(*command, "--max-frames", options->protocol.max_num_frames, 0,
            "Frames after which the session ends with DIE; 0: no limit");
  command->add_flag("--full-screen", options->full_screen, "Write every pixel of a screen instead of runs");
  command->callback([options] { throw CLI::RuntimeError(serve(*options)); });
}

}  // namespace racebeam
