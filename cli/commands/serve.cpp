#include "cli/commands/serve.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <stdexcept>
#include <system_error>

#include "cli/arguments/own_games.hpp"
#include "cli/commands/serve_options.hpp"
#include "cli/commands/shared_caches.hpp"
#include "emulator/translator/translator.hpp"
#include "environment/vector/thread_pool.hpp"
#include "recording/recorder.hpp"
#include "server/operation/log.hpp"
#include "server/operation/published_file.hpp"
#include "server/server.hpp"
#include "system/printable.hpp"
#include "system/program/signals.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

constexpr auto kServeFooter =
    R"(Without --classic, the server speaks the racebeam line protocol (protocol/PROTOCOL.md): a request is a line of
text, and so is the reply. Each client loads a game of its choice. By hand: racebeam serve --stdio, then type
help.

With --classic, it speaks the text protocol of ALE 0.4 to 0.6 (protocol/CLASSIC.md): the server sends 160-210,
and the client answers with four flags, such as 1,1,0,1 for screen, RAM and reward. Then the client sends
actions, such as 3,18, and gets a line for each. All clients play the game of the command line, with its
settings.

Each option --some-name is also the environment variable RACEBEAM_SOME_NAME, and the key some_name of the TOML
file of --config, in this order of precedence. racebeam config shows the settings in effect.

With --classic, one random generator serves the machine and the sticky actions, as in ALE 0.4 to 0.6;
--system-seed is not used. The log, on standard error, has the seed of each session.

Only the protocol is written to standard output. SIGTERM and SIGINT stop the server: it accepts no more
connections, finishes requests, and gives sessions on sockets --grace seconds to end. A second signal ends it
at once. SIGHUP makes it read tokens and certificate again. A server without sockets ends with its sessions.

Exit status:
  0    the sessions ended, or SIGTERM, SIGINT or --until-idle stopped the server
  1    the start failed for another reason than those below; or the client of --stdio or --pipes
       stopped reading, caused an error with --strict, or sent an invalid line with --classic
  2    usage error in the command line or the configuration
  3    the server cannot listen on an address: it is in use, or the host is unknown
  4    the folder of --roms or --record-dir is missing
  5    the memory is not enough
  255  a classic client requested an action that does not exist

Examples:
  racebeam serve --stdio
      one session on standard streams; try printf 'load beamfall\nact FIRE\n' | racebeam serve ...
  racebeam serve --stdio --strict <requests >replies
      for scripts: ends with status 1 after the first error, which is the last reply
  racebeam serve --listen tcp://127.0.0.1:0 --listen unix:racebeam.sock --roms ~/atari
      a session for each client, until the server is stopped (SIGTERM)
  racebeam serve --classic --stdio --rom tetris.bin --seed 1
      one session; try printf '0,0,0,1\n3,18\n' | racebeam serve ...
  racebeam serve --classic --pipes /run/user/1000/tetris --rom tetris.bin
      one session over the named pipes tetris_out and tetris_in; open tetris_out first, for reading
  racebeam serve --listen tcp://127.0.0.1:0 --listen classic+unix:tetris.sock --rom tetris.bin
      both protocols at once; each client has its own machine
  racebeam serve --listen tls://0.0.0.0:7800 --token-file tokens --tls-cert c.pem --tls-key k.pem
      for clients on other machines; server/README.md is the manual for operators)";

// Failures of the start, each with its own exit status, for schedulers.
constexpr int kExitAddress = 3, kExitFolder = 4, kExitMemory = 5;

struct FolderError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};
struct MemoryError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

void check_folder(const std::string& option, const std::string& path) {
  if (!path.empty() && !std::filesystem::is_directory(path))
    throw FolderError(option + " " + path + " is not a folder");
}

// The files that the process may open. Some are not for sessions, but for the server itself, for --http, for
// recordings, and for connections that are being closed.
struct Files {
  std::uint64_t all, others;
  std::uint64_t for_sessions() const { return all - 2 * others; }
};

Files files_of_process() {
  constexpr std::uint64_t kMaxFiles = 1 << 20, kMaxOthers = 128;
  const std::uint64_t all = std::min(usable_files(), kMaxFiles);
  return {all, std::min(kMaxOthers, all / 4)};
}

// Recordings may have the files that no session can take, and half of those for others.
std::size_t files_for_recordings(int max_sessions) {
  const Files files = files_of_process();
  const auto sessions = std::min(files.for_sessions(), static_cast<std::uint64_t>(max_sessions));
  return files.for_sessions() - sessions + files.others / 2;
}

ClassicService classic_service(const ServeOptions& options, const std::shared_ptr<Disposal>& disposal) {
  const auto tell = [](const std::string& sentence) { log_warning(sentence); };
  const auto power_on_one = [options, cartridge = open_cartridge(options.machine, tell)](Pace* pace) {
    MachineOptions machine = options.machine;
    machine.settings.classic = true;
    machine.settings.random_seed = resolve_seed(machine.settings.random_seed);
    return power_on(cartridge, machine, pace);
  };
  return {power_on_one, options.protocol, nullptr, disposal};
}

LineService line_service(const ServeOptions& options, ThreadPool& pool,
                         const std::shared_ptr<Disposal>& disposal) {
  check_folder("--record-dir", options.record_folder);
  LineService service;
  service.disposal = disposal;
  service.version = RACEBEAM_VERSION;
  service.images = std::make_shared<Images>(offered_images(options));
  for (const std::string& warning : service.images->warnings()) log_warning(warning);
  service.limits = options.limits;
  if (!options.record_folder.empty())
    service.recorder =
        std::make_shared<Recorder>(options.record_folder, files_for_recordings(options.server.max_sessions));
  service.threads = static_cast<std::size_t>(options.server.threads);
  service.cpu = options.machine.settings.cpu;
  service.strict = options.strict;
  service.share_all = options.watch_all;
  service.report_fault = [](const std::string& sentence) { log(LogLevel::kError, sentence); };
  service.report_old_word = [](const std::string& sentence) { log_warning(sentence); };
  service.parallel = [&pool](std::size_t count, const std::function<void(std::size_t)>& task) {
    pool.run(count, task);
  };
  return service;
}

// Logged once, because it applies to all machines.
void tell_obstacle(CpuKind cpu) {
  const std::string obstacle = Translator::obstacle();
  if (cpu == CpuKind::kAuto && !obstacle.empty())
    log("instructions are interpreted, not translated: " + obstacle);
}

// What decides about a setting, for the log: its option, or what limits its default.
std::string limit_of(const std::vector<Setting>& settings, const std::string& key, const std::string& limit) {
  const auto is_it = [&](const Setting& setting) { return setting.key == key; };
  const Setting& setting = *std::ranges::find_if(settings, is_it);
  return setting.source == Source::kDefault ? limit : setting.name();
}

// Charges the memory of the server itself, and of what sessions share.
void limit_memory(Services& services, std::uint64_t most, const SharedCaches& caches) {
  if (most == 0) return;
  const auto budget = std::make_shared<MemoryBudget>(most);
  budget->take_anyway(resident_memory() + caches.bytes);
  if (budget->taken() >= most) {
    throw MemoryError("--max-memory " + std::to_string(most) + " is too little: the server itself uses " +
                      std::to_string(budget->taken()) + " bytes");
  }
  if (services.classic) std::get<ClassicService>(*services.classic).memory = budget;
  if (services.line) std::get<LineService>(*services.line).memory = budget;
}

// A session on a socket takes a file, and so does a connection that is being closed.
void limit_connections(ServerSettings& server) {
  const Files files = files_of_process();
  server.max_connections = static_cast<int>(files.all - files.others);
  const auto sessions = static_cast<int>(files.for_sessions());
  if (server.max_sessions <= sessions) return;
  server.max_sessions = sessions;
  server.sessions_limited_by = "the open files (ulimit -n)";
}

int serve(const ServeOptions& options, const SharedCaches& caches) {
  ThreadPool pool(serves(options, false) ? static_cast<unsigned>(options.server.threads) : 1,
                  options.server.busy_poll);
  Services services;
  const auto disposal = std::make_shared<Disposal>();
  if (serves(options, true)) services.classic = classic_service(options, disposal);
  if (serves(options, false)) services.line = line_service(options, pool, disposal);
  limit_memory(services, options.server.max_memory, caches);
  return serve(options.server, services);
}

// The last line of a server that fails, in the format of its log, unless that has got no thread. Returns
// `status`.
int fail(LogFormat format, const std::string& sentence, int status) {
  try {
    if (format == LogFormat::kJson) return log(LogLevel::kError, sentence), status;
  } catch (const std::system_error&) {
  }
  std::cerr << "racebeam: " << printable(sentence) << "\n";
  return status;
}

}  // namespace

Images offered_images(const ServeOptions& options) {
  check_folder("--roms", options.roms);
  Images images;
  if (!options.machine.rom.empty())
    images.add_file(options.machine.rom, options.machine.game, options.machine.game_file,
                    options.machine.console);
  const OwnGames own(options.machine.game_file.value_or(""));
  if (!options.roms.empty()) images.add_folder(options.roms, own.games());
  images.add_built_in(own.games());
  const bool is_given = !options.machine.rom.empty() && own.games().size() == 1;  // to the image of --rom
  if (!is_given) own.check_use(images, places_of_images(options));
  return images;
}

std::string places_of_images(const ServeOptions& options) {
  std::string all = "the program's own games";
  if (!options.machine.rom.empty()) all += ", --rom " + options.machine.rom;
  return all + (options.roms.empty() ? "; --roms DIR names a folder of images" : ", --roms " + options.roms);
}

int run_server(ServeOptions& options, const std::vector<Setting>& settings) {
  ignore_reading_signal();  // until the server reads its files, which happens after this
  set_thread_stacks();
  return_large_blocks();
  // Before anything slow, and before anything that may fail.
  remove_stale(kReadyFile, options.server.ready_file);
  remove_stale(kAnnounceFile, options.server.announce);
  finish(options, settings);
  const auto fails = [&](const std::exception& error, int status) {
    return fail(options.log_format, error.what(), status);
  };
  try {
    set_up_log(options.log_level, options.log_format);
    options.server.threads_limited_by = limit_of(settings, "threads", usable_processors().limited_by);
    limit_connections(options.server);
    options.server.memory_limited_by = limit_of(settings, "max_memory", usable_memory().limited_by);
    const SharedCaches caches = shared_caches_for(options.server.max_memory);
    options.server.caches = text_of(caches);
    use(caches);
    tell_obstacle(options.machine.settings.cpu);
    return serve(options, caches);
  } catch (const AddressError& error) {
    return fails(error, kExitAddress);
  } catch (const FolderError& error) {
    return fails(error, kExitFolder);
  } catch (const MemoryError& error) {
    return fails(error, kExitMemory);
  } catch (const std::bad_alloc&) {
    return fail(options.log_format, "the system gives no more memory", kExitMemory);
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) return fails(error, kExitFailure);
    return fail(options.log_format, "the system gives no more memory for a thread, or allows no more threads",
                kExitMemory);
  } catch (const std::exception& error) {
    return fails(error, kExitFailure);
  }
}

void add_serve(Subcommand& program) {
  Subcommand command =
      program.add_subcommand("serve", "Serve games to agents, over a pipe or a socket", kServeFooter);
  const auto options = std::make_shared<ServeOptions>();
  add_serve_options(command, *options);
  command.exits_with([options, command] { return run_server(*options, complete(command)); });
}

}  // namespace racebeam
