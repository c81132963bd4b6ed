#include "tests/server/wire/line_channel.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>

namespace wire {
namespace {

int checked(int result, const char* what) {
  if (result >= 0) return result;
  throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

sockaddr_un unix_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  return address;
}

sockaddr_in tcp_address(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

template <typename Address>
sockaddr* general(Address& address) {
  return reinterpret_cast<sockaddr*>(&address);
}

void do_not_delay(int socket) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

constexpr unsigned kClientProcessor = 0, kServerProcessor = 1;
bool apart = false;

void stay_on(unsigned processor) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(processor, &set);
  checked(::sched_setaffinity(0, sizeof set, &set), "sched_setaffinity");
}

}  // namespace

void put_apart() {
  apart = true;
  stay_on(kClientProcessor);
}

void run_as_server() {
  if (apart) stay_on(kServerProcessor);
}

void LineChannel::send(int descriptor, std::string_view text) {
  while (!text.empty())
    text.remove_prefix(static_cast<std::size_t>(
        checked(static_cast<int>(::write(descriptor, text.data(), text.size())), "write")));
}

std::string_view LineChannel::line() {
  std::size_t searched = begin_;
  for (;;) {
    const auto* feed =
        static_cast<const char*>(std::memchr(buffer_.data() + searched, '\n', end_ - searched));
    if (feed != nullptr) {
      const std::size_t begin = begin_;
      begin_ = static_cast<std::size_t>(feed - buffer_.data()) + 1;
      return std::string_view(buffer_).substr(begin, begin_ - begin);
    }
    if (begin_ > 0) {
      std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
      end_ -= begin_;
      begin_ = 0;
    }
    searched = end_;
    if (end_ == buffer_.size()) buffer_.resize(2 * buffer_.size());
    const ssize_t count = ::read(in_, buffer_.data() + end_, buffer_.size() - end_);
    if (count <= 0) return {};
    end_ += static_cast<std::size_t>(count);
  }
}

Child start(const std::vector<std::string>& command) {
  std::array<int, 2> to{}, from{};
  checked(::pipe2(to.data(), O_CLOEXEC), "pipe");
  checked(::pipe2(from.data(), O_CLOEXEC), "pipe");
  const pid_t process = checked(::fork(), "fork");
  if (process == 0) {
    run_as_server();
    ::dup2(to[0], STDIN_FILENO);
    ::dup2(from[1], STDOUT_FILENO);
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    ::execv(words[0], words.data());
    ::_exit(127);
  }
  ::close(to[0]);
  ::close(from[1]);
  return {process, from[0], to[1]};
}

void stop(const Child& child) {
  ::close(child.out);
  ::close(child.in);
  ::waitpid(child.process, nullptr, 0);
}

int connect_unix(const std::string& path) {
  const int socket = checked(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0), "socket");
  sockaddr_un address = unix_address(path);
  checked(::connect(socket, general(address), sizeof address), "connect");
  return socket;
}

int connect_tcp(int port) {
  const int socket = checked(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), "socket");
  sockaddr_in address = tcp_address(port);
  checked(::connect(socket, general(address), sizeof address), "connect");
  do_not_delay(socket);
  return socket;
}

int listen_unix(const std::string& path) {
  const int socket = checked(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0), "socket");
  sockaddr_un address = unix_address(path);
  checked(::bind(socket, general(address), sizeof address), "bind");
  checked(::listen(socket, 1), "listen");
  return socket;
}

int listen_tcp(int& port) {
  const int socket = checked(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), "socket");
  sockaddr_in address = tcp_address(0);
  socklen_t size = sizeof address;
  checked(::bind(socket, general(address), sizeof address), "bind");
  checked(::listen(socket, 1), "listen");
  checked(::getsockname(socket, general(address), &size), "getsockname");
  port = ntohs(address.sin_port);
  return socket;
}

int accept_one(int listener) {
  const int socket = checked(::accept(listener, nullptr, nullptr), "accept");
  do_not_delay(socket);
  return socket;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace wire
