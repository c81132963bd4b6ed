#include "cli/serve.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "cli/options.hpp"
#include "server/address.hpp"
#include "server/sockets.hpp"
#include "server/streams.hpp"
#include "server/workers.hpp"

namespace racebeam {
namespace {

constexpr auto kFooter =
    R"(Without --classic it speaks the racebeam line protocol (protocol/PROTOCOL.md): a line of text asks, a
line of text answers, and every client loads the game that it wants. By hand: racebeam serve --stdio, then
type help.

--classic is the text protocol of ALE 0.4 to 0.6 (protocol/CLASSIC.md): the server says 160-210; the client
answers with four flags, 1,1,0,1 for screen, RAM and reward; from then on it sends actions, 3,18, and gets a
line for each. The game and its settings are those of the command line, the same for all.

Examples:
  racebeam serve --stdio
      one session on standard input and output; try printf 'load beamfall\nact FIRE\n' | racebeam serve ...
  racebeam serve --listen tcp://127.0.0.1:0 --listen unix:racebeam.sock --roms ~/atari
      until it is told to stop (SIGTERM), a session for everyone who connects
  racebeam serve --classic --stdio --rom tetris.bin --seed 1
      one session; try printf '0,0,0,1\n3,18\n' | racebeam serve ...
  racebeam serve --classic --pipes /run/user/1000/tetris --rom tetris.bin
      one session over the named pipes tetris_out and tetris_in; open tetris_out first, for reading
  racebeam serve --classic --listen tcp://127.0.0.1:0 --listen unix:tetris.sock --rom tetris.bin
      until it is told to stop, a machine of its own for everyone who connects

With --classic one generator serves the machine and what is random in play, as it did then: --system-seed is
not used. The seed of each session is in the log, on standard error.

Standard output carries the protocol and nothing else. Exit status: 0 the session ended, or SIGTERM or SIGINT
came; 1 the start failed, or the client of --stdio or --pipes stopped reading or, with --classic, sent what
makes no sense; 2 the command line makes no sense; 255 a classic client asked for an action that does not
exist.)";

// What the client of a line protocol says itself, when it loads a game.
constexpr const char* kClassicOnly[] = {
    "--seed",       "--system-seed",        "--frame-skip", "--sticky",      "--mode",
    "--difficulty", "--max-episode-frames", "--max-frames", "--full-screen", "--color-averaging"};
constexpr const char* kLineOnly[] = {"--record-dir"};  // --roms may come from the environment

struct ServeOptions {
  MachineOptions machine;
  ClassicOptions protocol;
  bool classic = false, standard_streams = false, full_screen = false;
  std::string pipes, roms, record_folder;
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

template <typename Names>
void refuse_any_of(const CLI::App& command, const Names& names, const std::string& why) {
  for (const char* name : names) {
    if (command.get_option(name)->count() > 0) throw CLI::ValidationError(name, why);
  }
}

void check(const ServeOptions& options, const CLI::App& command) {
  if (options.classic) {
    if (options.machine.rom.empty()) throw CLI::ValidationError("serve", "--rom is required with --classic");
    refuse_any_of(command, kLineOnly, "does not go with --classic");
  } else {
    refuse_any_of(command, kClassicOnly, "goes with --classic; in the line protocol, load sets it");
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

LineService make_service(const ServeOptions& options, Workers& workers, unsigned threads) {
  const auto images = std::make_shared<Images>();
  if (!options.machine.rom.empty())
    images->add_file(options.machine.rom, options.machine.game, options.machine.game_file);
  if (!options.roms.empty()) images->add_folder(options.roms);
  if (!options.record_folder.empty() && !std::filesystem::is_directory(options.record_folder))
    throw std::invalid_argument("--record-dir " + options.record_folder + " is not a folder");
  LineService service;
  service.version = RACEBEAM_VERSION;
  service.images = images;
  service.record_folder = options.record_folder;
  service.threads = threads;
  service.parallel = [&workers](std::size_t count, const std::function<void(std::size_t)>& task) {
    workers.run(count, task);
  };
  return service;
}

int serve(const ServeOptions& options, const Service& service) {
  if (options.standard_streams) return serve_standard_streams(service);
  if (!options.pipes.empty()) return serve_pipes(options.pipes, service);
  return serve_sockets(options.addresses, service);
}

int serve(ServeOptions& options, const CLI::App& command) {
  check(options, command);
  if (options.classic) {
    options.protocol.run_length = !options.full_screen;
    options.machine.settings.classic = true;
    return serve(options, make_service(options));
  }
  const unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  Workers workers(threads);
  return serve(options, make_service(options, workers, threads));
}

}  // namespace

void add_serve(CLI::App& app) {
  CLI::App* command = app.add_subcommand("serve", "Serve games to agents, over a pipe or a socket");
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
  command->get_option("--rom")->required(false);
  add_count(*command, "--max-episode-frames", options->machine.settings.max_episode_frames, 0,
            "Frames after which an episode is cut short; 0: no limit");
  add_count(*command, "--max-frames", options->protocol.max_num_frames, 0,
            "Frames after which the session ends with DIE; 0: no limit");
  command->add_flag("--full-screen", options->full_screen, "Write every pixel of a screen instead of runs");
  command->add_option("--roms", options->roms, "A folder with cartridge images that clients may load")
      ->type_name("DIR")
      ->envname("RACEBEAM_ROMS");
  command->add_option("--record-dir", options->record_folder, "A folder that clients may record into")
      ->type_name("DIR");
  command->callback([options, command] { throw CLI::RuntimeError(serve(*options, *command)); });
}

}  // namespace racebeam
