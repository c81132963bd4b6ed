#include "server/server.hpp"

#include <limits>
#include <list>
#include <memory>
#include <stdexcept>

#include "recording/recorder.hpp"
#include "server/connections/access_control.hpp"
#include "server/connections/connection_acceptor.hpp"
#include "server/connections/idle_monitor.hpp"
#include "server/connections/streams.hpp"
#include "server/operation/announcement.hpp"
#include "server/operation/log.hpp"
#include "server/operation/published_file.hpp"
#include "server/scheduling/keep_running.hpp"
#include "server/web/http.hpp"
#include "system/program/activation.hpp"
#include "system/program/signals.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using namespace std::chrono_literals;

// Times after the grace period: to send each client a last error, to send pending bytes, to finish
// recordings. Together with the Recorder's own limit, they are a second at most.
constexpr auto kBetweenSteps = 5ms;  // between two checks of whether all has ended
constexpr auto kFarewell = 700ms, kLastBytes = 100ms, kLastFrames = 50ms;

std::shared_ptr<Recorder> recorder_of(const Services& services) {
  return services.line ? std::get<LineService>(*services.line).recorder : nullptr;
}

class Server {
 public:
  Server(const ServerSettings& settings, const Services& services);
  int run();

 private:
  void start();
  void open_http();
  void log_limits() const;
  int files_for_clients() const;  // throws std::runtime_error if no file is left
  void publish();                 // writes the ready file and the announce file
  std::string announcement() const;
  Task<> handle_signals();
  Task<> stop_when_idle();
  void stop(const std::string& reason);  // `reason` is for the log
  Task<> wind_down();                    // waits for the grace period, then ends all sessions
  Task<> wait_for_next_check();
  Task<> end_with_recordings();
  bool sessions_ended() const;
  bool all_ended() const;
  void stop_streams(bool at_once);
  bool streams_ended() const;
  int status() const;

  const ServerSettings& settings_;
  const Services& services_;
  const std::string token_;  // for the announce file; empty: none
  Metrics metrics_;
  AccessControl access_;
  Loops loops_;
  net::io_context& first_;
  net::signal_set signals_;
  IdleMonitor idle_monitor_;
  std::list<PublishedFile> published_;
  ConnectionAcceptor acceptor_;
  std::shared_ptr<Recorder> recorder_;  // null: recording is off
  std::list<StreamSession> streams_;
  std::unique_ptr<Http> http_;
  bool stopping_ = false;           // after a signal, or after --until-idle
  bool graceful_ = true;            // until the second one, which ends the grace period
  std::string reason_;              // why the server stops; empty once it is logged
  Clock::time_point grace_;         // the end of the grace period, once the server is told to stop
  std::atomic<bool> ready_ = true;  // for /readyz
};

Server::Server(const ServerSettings& settings, const Services& services)
    : settings_(settings),
      services_(services),
      token_(settings.announce.empty() ? std::string() : random_token()),
      access_(settings, services, token_),
      loops_(static_cast<unsigned>(settings.threads), settings.busy_poll, metrics_),
      first_(loops_.first().context),
      signals_(first_),
      idle_monitor_(settings, loops_, metrics_),
      acceptor_(settings, services, access_, loops_, metrics_),
      recorder_(recorder_of(services)) {
  for (const int number : ending_signals()) signals_.add(number);
  if (reading_signal() != 0) signals_.add(reading_signal());
  metrics_.memory = memory_of(services.line ? *services.line : *services.classic);
  for (const Endpoint& endpoint : settings.endpoints) {
    if (!is_stream(endpoint.address)) continue;
    streams_.emplace_back(endpoint, endpoint.classic ? *services.classic : *services.line, settings.busy_poll,
                          metrics_);
  }
  if (!settings.http.empty()) http_ = std::make_unique<Http>(first_, parse_host_and_port(settings.http));
}

void Server::log_limits() const {
  log("threads: " + std::to_string(settings_.threads) + ", limited by " + settings_.threads_limited_by,
      {{"event", "threads"}});
  if (!settings_.sessions_limited_by.empty()) {
    log("sessions: " + std::to_string(settings_.max_sessions) + ", limited by " +
            settings_.sessions_limited_by,
        {{"event", "sessions"}});
  }
  if (settings_.max_memory == 0) return;
  log("memory: " + std::to_string(settings_.max_memory) + " bytes, limited by " + settings_.memory_limited_by,
      {{"event", "memory"}});
  log("caches: " + settings_.caches, {{"event", "caches"}});
}

// Returns how many files are left for clients. If the process may open only few, these are the files that are
// not open yet, less a reserve: a client that is refused takes one, too, and so do --http and the token file.
// If it may open many, the settings have already limited the number of sessions.
int Server::files_for_clients() const {
  constexpr std::uint64_t kMany = 1024, kOthers = 4;
  const auto needed = [](std::uint64_t most) { return open_files(most) + kOthers; };
  const std::uint64_t files = usable_files();
  if (files >= kMany) return std::numeric_limits<int>::max();
  if (files > needed(files)) return static_cast<int>(files - needed(files));
  std::uint64_t enough = files + 1;
  while (enough <= needed(enough)) ++enough;  // a parent may have left files open beyond this limit
  throw std::runtime_error("the server may open " + std::to_string(files) +
                           " files (ulimit -n), but with these settings it needs at least " +
                           std::to_string(enough));
}

std::string Server::announcement() const {
  const auto& line = std::get<LineService>(*services_.line);
  const auto games = line.images->names();
  const std::string host = host_name();
  return announce_text({acceptor_.announced(host), host, line.version, token_, process_number(),
                        std::vector<std::string>(games.begin(), games.end())});
}

void Server::publish() {
  std::vector<std::string> names = acceptor_.names();
  for (const StreamSession& stream : streams_) names.push_back(stream.name());
  if (http_) names.push_back(http_->name());
  if (!settings_.ready_file.empty())
    published_.emplace_back(kReadyFile, settings_.ready_file, ready_text(names));
  if (!settings_.announce.empty()) published_.emplace_back(kAnnounceFile, settings_.announce, announcement());
}

void Server::start() {
  if (!acceptor_.empty()) log_limits();
  if (!acceptor_.empty() || http_) acceptor_.open(files_for_clients());
  if (http_) open_http();
  idle_monitor_.start();
  for (StreamSession& stream : streams_) {
    stream.start([this] {
      retry_until_memory(
          [this] { keep_running(first_, "the end", [this] { return end_with_recordings(); }); });
    });
  }
  publish();  // may throw
  for (StreamSession& stream : streams_) stream.begin();
  notify_manager("READY=1");
}

void Server::open_http() {
  const OperatorPages pages{[this] { return ready_.load(); }, [this] { return metrics_.text(); }};
  http_->open({pages, access_.session_rules(http_->is_loopback())},
              [this](Socket socket, HttpRequest request) {
                acceptor_.admit_over_http(std::move(socket), std::move(request), http_->name());
              });
  log("health and metrics on " + http_->name(), {{"event", "listening"}, {"address", http_->name()}});
}

int Server::run() {
  loops_.start();  // first, so that a client that reads that the server is ready finds a thread
  keep_running(first_, "handling signals", [this] { return handle_signals(); });
  if (settings_.until_idle_seconds > 0)
    keep_running(first_, "looking for sessions", [this] { return stop_when_idle(); });
  start();
  loops_.run();
  return status();
}

Task<> Server::handle_signals() {
  for (;;) {
    const int number = co_await signals_.async_wait(use_task);
    if (number == reading_signal()) {
      access_.read_again();
    } else if (stopping_) {
      graceful_ = false;
    } else {
      stop("told to stop");
    }
  }
}

// Only admitted sessions count as use: clients without a token do not keep a server alive. A session that
// comes and goes between two checks shows in the total number of admitted sessions.
Task<> Server::stop_when_idle() {
  const auto limit = std::chrono::seconds(settings_.until_idle_seconds);
  net::steady_timer timer(first_);
  std::int64_t counted = 0;
  for (auto used = Clock::now(); Clock::now() - used < limit;) {
    timer.expires_after(100ms);
    co_await timer.async_wait(use_task);
    const std::int64_t admitted = metrics_.admitted;
    if (metrics_.admitted_open > 0 || !streams_ended() || admitted != counted) used = Clock::now();
    counted = admitted;
  }
  if (!stopping_) stop("no session for " + std::to_string(settings_.until_idle_seconds) + " seconds");
}

// Does not fail, since the signal that asks the server to stop may not come again.
void Server::stop(const std::string& reason) {
  grace_ = Clock::now() + std::chrono::seconds(settings_.grace_seconds);
  retry_until_memory([&] {
    reason_ = reason;
    keep_running(first_, "the end", [this] { return wind_down(); });
  });
  stopping_ = true;
}

Task<> Server::wait_for_next_check() { return pause(first_, kBetweenSteps); }

// Ends the server after the last session. Unless the server is told to stop, recordings take as long as they
// need.
Task<> Server::end_with_recordings() {
  if (!sessions_ended()) co_return;
  while (!all_ended()) co_await wait_for_next_check();
  if (!stopping_) loops_.stop();
}

// Sessions on streams have no grace period: their client is the one that stops the server.
Task<> Server::wind_down() {
  ready_ = false;
  published_.clear();  // the addresses are no longer valid
  notify_manager("STOPPING=1");
  acceptor_.close();
  if (!reason_.empty()) {
    log(reason_ + ": " + std::to_string(metrics_.sessions_open) + " sessions have " +
            std::to_string(settings_.grace_seconds) + " seconds to end",
        {{"event", "stopping"}});
    reason_.clear();
  }
  for (; !all_ended() && graceful_ && Clock::now() < grace_; co_await wait_for_next_check())
    stop_streams(false);
  idle_monitor_.end_all();
  const auto farewell = Clock::now() + kFarewell;
  for (; !all_ended() && Clock::now() < farewell; co_await wait_for_next_check()) stop_streams(true);
  // Waits for connections that are being closed while their last bytes are sent.
  const auto last = Clock::now() + kLastBytes;
  while (loops_.sessions() > 0 && Clock::now() < last) co_await wait_for_next_check();
  loops_.stop();
}

bool Server::all_ended() const { return sessions_ended() && (!recorder_ || recorder_->idle()); }

bool Server::sessions_ended() const {
  return streams_ended() && (stopping_ || acceptor_.empty()) && metrics_.sessions_open == 0;
}

void Server::stop_streams(bool at_once) {
  for (StreamSession& stream : streams_) stream.stop(at_once);
}

bool Server::streams_ended() const {
  return std::ranges::all_of(streams_, [](const StreamSession& stream) { return stream.ended(); });
}

int Server::status() const {
  if (stopping_) return 0;
  for (const StreamSession& stream : streams_) {
    if (stream.status() != 0) return stream.status();
  }
  return 0;
}

int run(const ServerSettings& settings, const Services& services) {
  try {
    return Server(settings, services).run();
  } catch (const boost::system::system_error& error) {
    if (error.code() != boost::system::errc::too_many_files_open) throw;
    throw std::runtime_error("the server needs more files than the " + std::to_string(usable_files()) +
                             " that it may open (ulimit -n)");
  }
}

}  // namespace

int serve(const ServerSettings& settings, const Services& services) {
  ignore_left_readers();
  const int status = run(settings, services);
  // Sessions that did not end in time are gone. Their recordings are finished here.
  if (const auto recorder = recorder_of(services)) recorder->end(kLastFrames);
  return status;
}

}  // namespace racebeam
