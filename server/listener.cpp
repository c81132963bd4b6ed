#include "server/listener.hpp"

#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace racebeam {
namespace {

namespace net = boost::asio;
using net::ip::tcp;
using Unix = net::local::stream_protocol;
using boost::system::error_code;

// A socket file outlives its server; nobody answers there any more.
void remove_stale(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) return;
  if (!std::filesystem::is_socket(path)) throw std::runtime_error(path + " exists, but is not a socket");
  net::io_context context;
  error_code error;
  Unix::socket(context).connect(Unix::endpoint(path), error);
  if (error == net::error::connection_refused) std::filesystem::remove(path);
}

ino_t file_number(const std::string& path) {
  struct stat found {};
  return ::stat(path.c_str(), &found) == 0 ? found.st_ino : 0;
}

}  // namespace

Listener::Listener(const net::any_io_executor& executor, const Address& address) : acceptor_(executor) {
  std::visit([this](const auto& kind) { listen(kind); }, address);
}

Listener::~Listener() {
  if (file_ != 0 && file_number(path_) == file_) ::unlink(path_.c_str());
}

void Listener::listen(const TcpAddress& address) {
  name_ = to_string(address);
  bind(tcp::endpoint(net::ip::make_address(address.host), address.port));
  tcp::endpoint bound;
  const Protocol::endpoint local = acceptor_.local_endpoint();
  std::memcpy(bound.data(), local.data(), local.size());
  name_ = to_string(TcpAddress{address.host, bound.port()});
}

void Listener::listen(const UnixAddress& address) {
  constexpr std::size_t kLongestPath = sizeof(sockaddr_un::sun_path) - 1;
  name_ = "unix:" + address.path;
  if (address.path.size() > kLongestPath) {
    throw std::runtime_error(name_ + " is too long; a socket's path has at most " +
                             std::to_string(kLongestPath) + " bytes");
  }
  remove_stale(address.path);
  bind(Unix::endpoint(address.path));
  path_ = address.path;
  file_ = file_number(path_);
}

void Listener::bind(const Protocol::endpoint& endpoint) {
  error_code error;
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(net::socket_base::reuse_address(true));
  acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  if (error == net::error::address_in_use) throw std::runtime_error(name_ + " is in use by another server");
  if (error) throw std::runtime_error("cannot listen on " + name_ + ": " + error.message());
}

}  // namespace racebeam
