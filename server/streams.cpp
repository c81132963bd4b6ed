#include "server/streams.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
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

int serve(Stream in, Stream out, Environment& machine, const ClassicOptions& options) {
  ClassicSession session(machine, options);
  try {
    if (converse(in, out, session)) return 0;
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

// Each open waits for the client's; a client that opens them in the other order waits for ever.
int serve_opened(const std::string& prefix, int output_flags, const ClassicService& service,
                 Environment& machine) {
  net::io_context context;
  log(describe(machine) + ", for a client that opens " + prefix + "_out for reading, then " + prefix +
      "_in for writing");
  Stream out(context, open_or_throw(prefix + "_out", O_WRONLY | output_flags));
  Stream in(context, open_or_throw(prefix + "_in", O_RDONLY));
  return serve(std::move(in), std::move(out), machine, service.options);
}

}  // namespace

int serve_standard_streams(const ClassicService& service) {
  handle_signals();
  Environment machine = service.power_on();
  log(describe(machine) + ", on standard input and output");
  net::io_context context;
  return serve(Stream(context, STDIN_FILENO), Stream(context, STDOUT_FILENO), machine, service.options);
}

int serve_pipes(const std::string& prefix, const ClassicService& service) {
  handle_signals();
  Environment machine = service.power_on();
  make_if_missing(prefix + "_out");
  make_if_missing(prefix + "_in");
  return serve_opened(prefix, 0, service, machine);
}

int serve_classic_pipes(const ClassicService& service) {
  handle_signals();
  Environment machine = service.power_on();
  return serve_opened("ale_fifo", O_CREAT | O_TRUNC, service, machine);
}

}  // namespace racebeam
