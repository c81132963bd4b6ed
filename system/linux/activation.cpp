#include "system/program/activation.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace racebeam {
namespace {

constexpr int kFirstDescriptor = 3, kMaxSockets = 1000;

std::optional<int> number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  const std::string_view digits = text;
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc{} && end == digits.data() + digits.size()) return number;
  throw std::runtime_error(std::string(variable) + " is '" + text + "', which is not a number");
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  const char* const text = std::getenv("LISTEN_FDNAMES");
  std::istringstream stream(text == nullptr ? "" : text);
  for (std::string name; std::getline(stream, name, ':');) all.push_back(name);
  return all;
}

void check_listening(int descriptor) {
  int listening = 0;
  socklen_t size = sizeof listening;
  if (::getsockopt(descriptor, SOL_SOCKET, SO_ACCEPTCONN, &listening, &size) == 0 && listening != 0) return;
  throw std::runtime_error("descriptor " + std::to_string(descriptor) +
                           " of LISTEN_FDS is not a socket that listens (Accept=no in the unit)");
}

}  // namespace

std::vector<InheritedSocket> inherited_sockets() {
  const auto process = number_in("LISTEN_PID"), count = number_in("LISTEN_FDS");
  if (!process || !count || *process != ::getpid()) return {};
  if (*count < 0 || *count > kMaxSockets)
    throw std::runtime_error("LISTEN_FDS is " + std::to_string(*count) + "; it must be 0 to 1000");
  const auto named = names();
  std::vector<InheritedSocket> sockets;
  for (int number = 0; number < *count; ++number) {
    const int descriptor = kFirstDescriptor + number;
    check_listening(descriptor);
    ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    const auto place = static_cast<std::size_t>(number);
    sockets.push_back({descriptor, place < named.size() ? named[place] : "unknown"});
  }
  return sockets;
}

void notify_manager(const std::string& state) {
  const char* const path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  const std::string_view name = path == nullptr ? "" : path;
  if (name.empty() || name.size() >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::ranges::copy(name, address.sun_path);
  if (name.front() == '@') address.sun_path[0] = '\0';  // an abstract socket (unix(7))
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  if (socket < 0) return;
  ::fcntl(socket, F_SETFD, FD_CLOEXEC);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  ::sendto(socket, state.data(), state.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address),
           size);
  ::close(socket);
}

}  // namespace racebeam
