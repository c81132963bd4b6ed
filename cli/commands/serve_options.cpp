#include "cli/commands/serve_options.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "server/web/origin.hpp"
#include "system/program/sockets.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

// Settings that a client of the line protocol chooses itself, when it loads a game.
constexpr const char* kClassicOnly[] = {"seed",        "system_seed",    "frame_skip",         "sticky",
                                        "mode",        "difficulty",     "max_episode_frames", "max_frames",
                                        "full_screen", "color_averaging"};
constexpr const char* kLineOnly[] = {"record_dir", "watch"};

// Groups of options in the help text.
constexpr auto kWhere = "Where", kClassic = "With --classic", kLimits = "Limits", kOperation = "Operation";

std::string check_endpoint(const std::string& text) {
  try {
    parse_endpoint(text);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

std::string check_origin(const std::string& text) {
  return is_origin(text)
             ? std::string()
             : "'" + text + "' is not an origin; accepted: http://HOST[:PORT] and https://HOST[:PORT]";
}

std::string check_host_and_port(const std::string& text) {
  try {
    parse_host_and_port(text);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

template <typename Number>
void add_number(Subcommand& command, const std::string& name, Number& value, std::int64_t least,
                const std::string& help) {
  constexpr auto kMax = std::min<std::uint64_t>(std::numeric_limits<Number>::max(), 1ULL << 60);
  command.option(name, value, help)
      .check(whole_number(least, static_cast<std::int64_t>(kMax)))
      .shows_default()
      .group(kLimits);
}

Option add_file(Subcommand& command, const std::string& name, std::string& value, const std::string& help) {
  return command.option(name, value, help).value_name("FILE");
}

void add_streams(Subcommand& command, ServeOptions& options) {
  command.flag("--stdio", options.standard_streams, "One session on standard input and output").group(kWhere);
  command
      .option("--pipes", options.pipes,
              "One session on the named pipes PREFIX_out and PREFIX_in, created if missing")
      .value_name("PREFIX")
      .group(kWhere);
}

void add_addresses(Subcommand& command, ServeOptions& options) {
  command
      .option(
          "--listen", options.addresses,
          "Sessions on tcp://HOST:PORT (port 0 picks one), tls://HOST:PORT, ws://HOST:PORT, "
          "wss://HOST:PORT, unix:PATH, systemd[:NAME], stdio or pipes:PREFIX, with classic+ before it for "
          "the classic protocol; repeatable")
      .value_name("ADDRESS")
      .check({check_endpoint, ""})
      .one_a_time()
      .group(kWhere);
  command
      .option("--allow-origin", options.server.allowed_origins,
              "Pages of this origin may open sessions, besides the server's own: http://HOST[:PORT] or "
              "https://HOST[:PORT]; repeatable")
      .value_name("ORIGIN")
      .check({check_origin, ""})
      .one_a_time()
      .group(kWhere);
}

void add_protocol(Subcommand& command, ServeOptions& options) {
  command.flag("--classic", options.classic, "Use the text protocol of ALE 0.4 to 0.6 on all addresses")
      .group(kWhere);
  command
      .flag("--strict", options.strict,
            "End a session on --stdio or --pipes at its first error, with status 1; for scripts")
      .group(kWhere);
}

void add_access(Subcommand& command, ServerSettings& server) {
  add_file(
      command, "--token-file", server.token_file,
      "File of tokens, one a line; clients over TCP must send one of them. Required for addresses that other "
      "machines can reach, unless --announce is given")
      .group(kWhere);
  add_file(command, "--tls-cert", server.tls_certificate, "Certificate chain for tls:// and wss://, in PEM")
      .group(kWhere);
  add_file(command, "--tls-key", server.tls_key, "Key of the certificate, in PEM").group(kWhere);
}

void add_transports(Subcommand& command, ServeOptions& options) {
  add_streams(command, options);
  add_addresses(command, options);
  add_protocol(command, options);
  add_access(command, options.server);
}

void add_limits(Subcommand& command, ServeOptions& options) {
  LineLimits& limits = options.limits;
  ServerSettings& server = options.server;
  add_number(command, "--max-sessions", server.max_sessions, 1,
             "The most sessions on sockets at the same time");
  add_number(command, "--max-machines", limits.machines, 1, "The most machines that a session may open");
  add_number(command, "--max-states", limits.states, 1, "The most states that a session may keep");
  add_number(command, "--max-line", limits.line, 256, "The most bytes of a request");
  add_number(command, "--max-output", limits.output, 1024,
             "Bytes that are buffered for a slow reader; beyond that, its requests wait");
  add_number(command, "--max-reply", limits.reply, 1 << 20,
             "The most bytes of a reply, counted as in PROTOCOL.md");
  add_number(command, "--max-request-frames", limits.request_frames, 1, "The most frames of a request");
  add_number(command, "--record-limit", limits.recording, 1, "The most bytes of a recording");
  add_number(command, "--idle", server.idle_seconds, 0,
             "Seconds without a byte after which a session on a socket is closed; 0: never");
  add_number(command, "--handshake", server.handshake_seconds, 1, "Seconds for TLS and the client's token");
  add_number(command, "--grace", server.grace_seconds, 0,
             "Seconds that sessions may continue after the server is told to stop");
  add_number(command, "--until-idle", server.until_idle_seconds, 0,
             "Seconds without a session after which the server stops, as on SIGTERM; 0: never");
}

void add_memory(Subcommand& command, ServerSettings& server) {
  server.max_memory = usable_memory().amount / 4 * 3;
  command
      .option("--max-memory", server.max_memory,
              "Bytes of memory for all sessions, also as 512M or 2G (default: three quarters of what the "
              "process may use); 0: no limit")
      .sizes()
      .shows_default()
      .group(kLimits);
}

void add_threads(Subcommand& command, ServerSettings& server) {
  constexpr std::uint64_t kMaxThreads = 1024;
  server.threads = static_cast<int>(std::min(usable_processors().amount, kMaxThreads));
  command
      .option(
          "--threads", server.threads,
          "Threads of event loops; as many others help with open and step (default: the usable processors)")
      .check(whole_number(1, kMaxThreads))
      .shows_default()
      .group(kOperation);
}

void add_busy_poll(Subcommand& command, std::chrono::microseconds& busy_poll) {
  const std::function<void(const std::string&)> set = [&busy_poll](const std::string& text) {
    busy_poll = std::chrono::microseconds(std::stoll(text));
  };
  command
      .option("--busy-poll", set,
              "Microseconds that a thread polls for a client whose requests follow at once; 0: never")
      .check(whole_number(0, 1'000'000))
      .default_text(std::to_string(busy_poll.count()))
      .value_name("INT")
      .group(kOperation);
}

void add_published_files(Subcommand& command, ServerSettings& server) {
  add_file(command, "--ready-file", server.ready_file,
           "File into which the server writes its addresses, one a line after # lines, once it serves them "
           "all; removed at the end")
      .group(kOperation);
  add_file(
      command, "--announce", server.announce,
      "JSON file for clients (file:PATH): addresses, host, process, games, and a token that clients over TCP "
      "must send; only its owner can read it; removed at the end")
      .group(kOperation);
}

void add_http(Subcommand& command, std::string& address) {
  command
      .option("--http", address,
              "The page for a browser, its sessions, and health and metrics: /, /session, /healthz, /readyz, "
              "/metrics")
      .value_name("HOST:PORT")
      .check({check_host_and_port, ""})
      .group(kOperation);
}

void add_sharing(Subcommand& command, bool& all) {
  command
      .choice<bool>("--watch", all, {{"shared", false}, {"all", true}}, "shared",
                    "Sessions that others may watch: shared, only those whose client has sent share; or all")
      .group(kOperation);
}

void add_log(Subcommand& command, ServeOptions& options) {
  command
      .choice<LogLevel>("--log-level", options.log_level,
                        {{"debug", LogLevel::kDebug},
                         {"info", LogLevel::kInfo},
                         {"warning", LogLevel::kWarning},
                         {"error", LogLevel::kError},
                         {"off", LogLevel::kOff}},
                        "info", "Lowest level that is logged: debug, info, warning, error or off")
      .group(kOperation);
  command
      .choice<LogFormat>("--log-format", options.log_format,
                         {{"text", LogFormat::kText}, {"json", LogFormat::kJson}}, "text",
                         "Format of the log: one line of text, or of JSON, for each event")
      .group(kOperation);
}

void add_operation(Subcommand& command, ServeOptions& options) {
  ServerSettings& server = options.server;
  add_threads(command, server);
  add_busy_poll(command, server.busy_poll);
  add_published_files(command, server);
  add_http(command, server.http);
  add_sharing(command, options.watch_all);
  add_log(command, options);
  command.option("--config", nullptr, "A TOML file with settings").value_name("FILE").group(kOperation);
}

void add_games(Subcommand& command, ServeOptions& options) {
  add_machine_options(command, options.machine);
  command.find("--rom").required(false);
  add_count(command, "--max-episode-frames", options.machine.settings.max_episode_frames, 0,
            "Frames after which an episode is truncated; 0: no limit");
  add_count(command, "--max-frames", options.protocol.max_num_frames, 0,
            "Frames after which the session ends with DIE; 0: no limit");
  command.flag("--full-screen", options.full_screen, "Write every pixel of a screen instead of runs");
  command.option("--roms", options.roms, "A folder with cartridge images that clients may load")
      .value_name("DIR");
  command.option("--record-dir", options.record_folder, "A folder that clients may record into")
      .value_name("DIR");
}

template <typename VariableNames>
void refuse_any_of(const std::vector<Setting>& settings, const VariableNames& names, const std::string& why) {
  for (const Setting& setting : settings) {
    const bool named = std::ranges::find(names, setting.key) != std::end(names);
    if (named && setting.source == Source::kCommandLine) throw UsageError(setting.name() + ": " + why);
  }
}

void collect_endpoints(ServeOptions& options) {
  std::vector<std::string> addresses = options.addresses;
  if (options.standard_streams) addresses.insert(addresses.begin(), "stdio");
  if (!options.pipes.empty() && !has_local_channels())
    throw UsageError("--pipes: Windows has no such named pipes; accepted: --stdio and --listen ADDRESS");
  if (!options.pipes.empty()) addresses.push_back("pipes:" + options.pipes);
  for (const std::string& address : addresses) {
    Endpoint endpoint = parse_endpoint(address);
    endpoint.classic |= options.classic;
    if (endpoint.classic && endpoint.web)
      throw UsageError("--listen: " + address + " excludes the classic protocol");
    options.server.endpoints.push_back(std::move(endpoint));
  }
  if (addresses.empty())
    throw UsageError("serve: no address to serve: give --stdio, --pipes PREFIX or --listen ADDRESS");
  std::set<std::string> streams;
  for (const Endpoint& endpoint : options.server.endpoints) {
    const std::string name = to_string(endpoint.address);
    if (is_stream(endpoint.address) && !streams.insert(name).second)
      throw UsageError("serve: " + name + " can serve only one session: give it once");
  }
}

// An error of one client must not end a server with other clients.
void check_strict(const ServeOptions& options) {
  if (!options.strict) return;
  const bool fits = std::ranges::all_of(options.server.endpoints, [](const Endpoint& endpoint) {
    return is_stream(endpoint.address) && !endpoint.classic;
  });
  if (!fits) throw UsageError("--strict: requires --stdio or --pipes, and the line protocol");
}

// Clients of an announce file speak the line protocol on a socket.
void check_announce(const ServeOptions& options) {
  if (options.server.announce.empty()) return;
  const bool fits = std::ranges::any_of(options.server.endpoints, [](const Endpoint& endpoint) {
    return !is_stream(endpoint.address) && !endpoint.classic;
  });
  if (!fits) throw UsageError("--announce: requires the line protocol on a socket: --listen ADDRESS");
}

}  // namespace

bool serves(const ServeOptions& options, bool classic) {
  return std::ranges::any_of(options.server.endpoints,
                             [classic](const Endpoint& endpoint) { return endpoint.classic == classic; });
}

void add_serve_options(Subcommand& command, ServeOptions& options) {
  add_transports(command, options);
  add_games(command, options);
  add_limits(command, options);
  add_memory(command, options.server);
  add_operation(command, options);
  group_classic_options(command, kClassic);
}

void group_classic_options(Subcommand& command, const std::string& group) {
  for (std::string name : kClassicOnly) {
    std::ranges::replace(name, '_', '-');
    command.find("--" + name).group(group);
  }
}

void finish(ServeOptions& options, const std::vector<Setting>& settings) {
  collect_endpoints(options);
  if (serves(options, true)) {
    if (options.machine.rom.empty()) throw UsageError("serve: --rom is required with --classic");
  } else {
    refuse_any_of(settings, kClassicOnly, "requires --classic; in the line protocol, load sets it");
  }
  if (!serves(options, false)) refuse_any_of(settings, kLineOnly, "excludes --classic");
  check_strict(options);
  check_announce(options);
  if (options.machine.game && options.machine.game_file) throw UsageError("--game-file: excludes --game");
  if (options.server.tls_certificate.empty() != options.server.tls_key.empty())
    throw UsageError("serve: --tls-cert and --tls-key must be given together");
  options.limits.idle_seconds = options.server.idle_seconds;
  options.protocol.run_length = !options.full_screen;
}

}  // namespace racebeam
