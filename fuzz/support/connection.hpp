// A connection whose both ends are in this process: the server's is that of Asio, and the target is the
// client. Everything is done in one thread, so that an input always has the same effect.
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>

#include "server/scheduling/task.hpp"
#include "server/web/byte_stream.hpp"

namespace racebeam::fuzz {

class Connection {
 public:
  Connection() : socket_(loop_) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw std::runtime_error("cannot make a connection");
    client_ = ends[0];
    socket_.assign(boost::asio::generic::stream_protocol(AF_UNIX, 0), ends[1]);
  }
  ~Connection() {
    if (client_ >= 0) ::close(client_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  ByteStream::Socket& socket() { return socket_; }  // the server's end

  void serve(Task<> task) {
    spawn(loop_, std::move(task));
    run();
  }

  // Sends the bytes in pieces of at most `piece`. The server works after each. What it does not read is lost.
  void say(std::string_view bytes, std::size_t piece) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(client_, bytes.data(), std::min(bytes.size(), piece), MSG_NOSIGNAL);
      if (count <= 0) return;
      bytes.remove_prefix(static_cast<std::size_t>(count));
      run();
    }
  }

  // The client sends nothing more.
  void end() {
    ::shutdown(client_, SHUT_WR);
    run();
  }

  const std::string& answers() const { return answers_; }  // what the server has sent
  void forget_answers() { answers_.clear(); }

 private:
  // Until the server waits for the client.
  void run() {
    bool more = true;
    while (more) {
      loop_.restart();
      more = loop_.poll() > 0;
      more = listen() || more;
    }
  }

  bool listen() {
    std::array<char, 1 << 16> part;
    const ssize_t count = ::recv(client_, part.data(), part.size(), 0);
    if (count <= 0) return false;
    answers_.append(part.data(), static_cast<std::size_t>(count));
    return true;
  }

  boost::asio::io_context loop_{1};
  ByteStream::Socket socket_;
  int client_ = -1;
  std::string answers_;
};

}  // namespace racebeam::fuzz
