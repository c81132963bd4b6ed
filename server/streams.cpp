#include "server/streams.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include <boost/asio.hpp>

#include "server/log.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using Stream = net::posix::stream_descriptor;

constexpr int kClientGone = 1;  // exit status: it stopped reading in the middle

void handle_signals() {
  std::signal(SIGPIPE, SIG_IGN);
  for (const int number : {SIGTERM, SIGINT}) std::signal(number, [](int) { ::_exit(0); });
}

// False: the client stopped reading.
bool converse(Stream& in, Stream& out, ClassicSession& session) {
  boost::system::error_code error;
  while (!session.ended()) {
    if (const auto text = session.reply()) {
      net::write(out, net::buffer(*text), error);
      if (error && !session.ended()) return false;
    } else {
      const auto space = session.space();
      session.received(in.read_some(net::buffer(space.data(), space.size()), error));
    }
  }
  return true;
}

bool converse(Stream& in, Stream& out, LineSession& session) {
  boost::system::error_code error;
  while (!session.finished()) {
    const bool more = session.run();
    const auto text = session.output();
    net::write(out, net::buffer(text), error);
    if (error) return false;
    session.sent(text.size());
    if (more || session.finished()) continue;
    const auto space = session.space();
    session.received(in.read_some(net::buffer(space.data(), space.size()), error));
  }
  return true;
}

// A session that waits for its streams. Made before they are opened: who starts the server hears at once when
// the machine can't be had.
class Waiting {
 public:
  virtual ~Waiting() = default;
  virtual int serve(Stream in, Stream out) = 0;  // the exit status
  virtual std::string description() const = 0;
};

class WaitingLine final : public Waiting {
 public:
  explicit WaitingLine(const LineService& service) : session_(service) {}

  int serve(Stream in, Stream out) override {
    if (converse(in, out, session_)) return 0;
    log("the client stopped reading");
    return kClientGone;
  }

  std::string description() const override { return "the line protocol"; }

 private:
  LineSession session_;
};

class WaitingClassic final : public Waiting {
 public:
  explicit WaitingClassic(const ClassicService& service)
      : machine_(service.power_on()), session_(machine_, service.options) {}

  int serve(Stream in, Stream out) override;
  std::string description() const override { return describe(machine_); }

 private:
  Environment machine_;
  ClassicSession session_;
};

int WaitingClassic::serve(Stream in, Stream out) {
  try {
    if (converse(in, out, session_)) return 0;
    log("the client stopped reading");
    return kClientGone;
  } catch (const ClassicError& error) {
    log(error.what());
    return error.status();
  }
}

int open_or_throw(const std::string& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor >= 0) return descriptor;
  throw std::runtime_error("cannot open the pipe " + path + ": " + std::generic_category().message(errno));
}

void make_if_missing(const std::string& path) {
  if (::mkfifo(path.c_str(), 0600) == 0) return log("made the pipe " + path);
  const int error = errno;
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) {
    throw std::runtime_error("cannot make the pipe " + path + ": " + std::generic_category().message(error));
  }
  if (!S_ISFIFO(found.st_mode)) throw std::runtime_error(path + " exists, but is not a named pipe");
}

std::unique_ptr<Waiting> await_client(const Service& service) {
  if (const auto* line = std::get_if<LineService>(&service)) return std::make_unique<WaitingLine>(*line);
  return std::make_unique<WaitingClassic>(std::get<ClassicService>(service));
}

// Each open waits for the client's; a client that opens them in the other order waits for ever.
int serve_opened(const std::string& prefix, int output_flags, Waiting& session) {
  net::io_context context;
  log(session.description() + ", for a client that opens " + prefix + "_out for reading, then " + prefix +
      "_in for writing");
  Stream out(context, open_or_throw(prefix + "_out", O_WRONLY | output_flags));
  Stream in(context, open_or_throw(prefix + "_in", O_RDONLY));
  return session.serve(std::move(in), std::move(out));
}

}  // namespace

int serve_standard_streams(const Service& service) {
  handle_signals();
  const auto session = await_client(service);
  log(session->description() + ", on standard input and output");
  net::io_context context;
  return session->serve(Stream(context, STDIN_FILENO), Stream(context, STDOUT_FILENO));
}

int serve_pipes(const std::string& prefix, const Service& service) {
  handle_signals();
  const auto session = await_client(service);
  make_if_missing(prefix + "_out");
  make_if_missing(prefix + "_in");
  return serve_opened(prefix, 0, *session);
}

int serve_classic_pipes(const ClassicService& service) {
  handle_signals();
  WaitingClassic session(service);
  return serve_opened("ale_fifo", O_CREAT | O_TRUNC, session);
}

}  // namespace racebeam
