#include "server/connections/streams.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "server/connections/session_loop.hpp"
#include "server/operation/log.hpp"
#include "system/program/standard_streams.hpp"

namespace racebeam {

using namespace std::chrono_literals;

// Exit statuses.
constexpr int kClientGone = 1;  // it stopped reading
constexpr int kRefused = 1;     // the first error of a strict session

// The session, made before its streams are opened.
class StreamSession::Conversation {
 public:
  virtual ~Conversation() = default;
  virtual int run(BlockingPair& streams, const Halt& halt) = 0;  // returns the exit status
  virtual std::string description() const = 0;
};

namespace {

int client_gone(const Halt& halt) {
  if (halt.all) return 0;
  log("the client stopped reading");
  return kClientGone;
}

// Returns whether there is a pipe.
bool refuse_other_file(const std::string& path) {
  const PathKind found = kind_of_path(path);
  if (found == PathKind::kOther) throw AddressError(path + " exists, but is not a named pipe");
  return found == PathKind::kPipe;
}

// The warning also appears if a client in the same step has made the pipe itself, which is not slow. The
// server cannot distinguish the two cases.
void warn_of_srun() {
  if (std::getenv("SLURM_STEP_ID") == nullptr || !is_pipe(kStandardOutput)) return;
  log_warning(
      "this is a step of a Slurm job: if srun forwards standard output, replies above 1,024 bytes take some "
      "40 ms more; a socket avoids that: --listen, or cluster/slurm/racebeam-srun COMMAND");
}

// Makes the pipe if it is missing. Returns what removes the pipe at the end, if this call has made it.
UnlinkOnExit make_if_missing(const std::string& path) {
  if (make_pipe(path)) {
    log("made the pipe " + path);
    return UnlinkOnExit(path);
  }
  const int error = errno;
  if (!refuse_other_file(path))
    throw AddressError("cannot make the pipe " + path + ": " + std::generic_category().message(error));
  return {};
}

}  // namespace

class StreamSession::LineConversation final : public Conversation {
 public:
  LineConversation(const LineService& service, Metrics& metrics, Meter& meter, int columns)
      : metrics_(metrics), meter_(meter), session_(service, &meter) {
    session_.set_columns(columns);
  }

  int run(BlockingPair& streams, const Halt& halt) override {
    using Next = SessionLoop::Next;
    SessionLoop loop(session_);
    for (;;) {
      Next next = loop.work([this] { return session_.run(); });
      if (next == Next::kSend) {
        if (!streams.write(loop.output())) return client_gone(halt);
        meter_.bytes_out.add(static_cast<std::int64_t>(loop.output().size()));
        next = loop.sent();
      }
      if (next == Next::kDone) break;
      if (next == Next::kRead) {
        const std::size_t count = streams.read(session_.space());
        if (halt.reading) break;
        meter_.bytes_in.add(static_cast<std::int64_t>(count));
        session_.received(count);
        continue;
      }
      if (halt.all) return send_farewell(streams), 0;
      if (streams.reader_left()) return client_gone(halt);
      if (next == Next::kPause) std::this_thread::sleep_for(1ms);
    }
    return session_.refused() ? kRefused : 0;
  }

  std::string description() const override { return "the line protocol"; }

 private:
  // Sends a last error. Called in the middle of a request whose reply has not begun.
  void send_farewell(BlockingPair& streams) {
    ++metrics_.ended_stopping;
    streams.write_at_once("error stopping the server stops\n");
  }

  Metrics& metrics_;
  Meter& meter_;
  LineSession session_;
};

class StreamSession::ClassicConversation final : public Conversation {
 public:
  ClassicConversation(const ClassicService& service, Meter& meter) : meter_(meter), session_(service) {
    while (!session_.work()) continue;
    session_.check_machine();
  }

  int run(BlockingPair& streams, const Halt& halt) override {
    try {
      return converse(streams, halt) ? 0 : client_gone(halt);
    } catch (const ClassicError& error) {
      log(error.what());
      return error.status();
    }
  }

  std::string description() const override { return describe(session_.machine()); }

 private:
  bool converse(BlockingPair& streams, const Halt& halt);  // returns false if the client stopped reading

  Meter& meter_;
  PacedClassic session_;
};

bool StreamSession::ClassicConversation::converse(BlockingPair& streams, const Halt& halt) {
  while (!session_.ended()) {
    if (!session_.work()) {
      if (halt.all || streams.reader_left()) return false;
    } else if (const auto text = session_.reply()) {
      if (!streams.write(*text) && !session_.ended()) return false;
      meter_.bytes_out.add(static_cast<std::int64_t>(text->size()));
      meter_.frames.add(session_.take_frames());
    } else {
      const std::size_t count = streams.read(session_.space());
      if (halt.reading) break;
      meter_.bytes_in.add(static_cast<std::int64_t>(count));
      session_.received(count);
    }
  }
  return true;
}

StreamSession::StreamSession(const Endpoint& endpoint, const Service& service,
                             std::chrono::microseconds busy_poll, Metrics& metrics)
    : address_(endpoint.address), name_(to_string(endpoint)), metrics_(metrics), streams_(halt_, busy_poll) {
  Meter& meter = metrics.add_meter();
  if (const auto* line = std::get_if<LineService>(&service)) {
    const bool standard = std::holds_alternative<StandardStreams>(address_);
    const int columns = standard ? terminal_columns(kStandardOutput) : 0;
    conversation_ = std::make_unique<LineConversation>(*line, metrics, meter, columns);
    ++metrics.sessions_line;
  } else {
    conversation_ = std::make_unique<ClassicConversation>(std::get<ClassicService>(service), meter);
    ++metrics.sessions_classic;
  }
  if (const auto* pipes = std::get_if<Pipes>(&address_)) {
    const std::array<std::string, 2> paths = {pipes->prefix + "_out", pipes->prefix + "_in"};
    for (const std::string& path : paths) refuse_other_file(path);  // checks both pipes before it makes one
    for (const std::string& path : paths) made_.push_back(make_if_missing(path));
  }
}

StreamSession::~StreamSession() {
  if (!beginning_.is_open()) halt_.reading = halt_.all = true;
  begin();
  if (thread_.joinable()) thread_.join();
}

void StreamSession::start(std::function<void()> ended) {
  on_end_ = std::move(ended);
  Halt::prepare();
  thread_ = std::jthread([this] {
    beginning_.wait();
    run();
  });
}

void StreamSession::begin() { beginning_.open(); }

void StreamSession::stop(bool at_once) {
  halt_.reading = true;
  if (at_once) halt_.all = true;
  if (thread_.joinable() && !ended_) Halt::wake(thread_);
}

void StreamSession::serve() {
  const Counted open(metrics_.sessions_open);
  try {
    if (!halt_.all && connect()) status_ = conversation_->run(streams_, halt_);
  } catch (const std::exception& error) {
    log(LogLevel::kError, error.what());
    status_ = 1;
  }
  conversation_.reset();  // commits its recordings before the end is reported
}

void StreamSession::run() {
  serve();
  ended_ = true;
  on_end_();
}

// Each open() waits until the client opens the other end. A client that opens the pipes in the other order
// waits for ever.
bool StreamSession::connect() {
  const std::string what = conversation_->description();
  if (std::holds_alternative<StandardStreams>(address_)) {
    log(what + ", on standard input and output");
    warn_of_srun();
    streams_.use(kStandardInput, kStandardOutput);
    return true;
  }
  const auto* pipes = std::get_if<Pipes>(&address_);
  const std::string prefix = pipes ? pipes->prefix : "ale_fifo";
  log(what + ", for a client that opens " + prefix + "_out for reading, then " + prefix + "_in for writing");
  refuse_other_file(prefix + "_out");
  return streams_.open_out(prefix + "_out", pipes == nullptr) && streams_.open_in(prefix + "_in");
}

}  // namespace racebeam
