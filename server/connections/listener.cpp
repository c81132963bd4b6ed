#include "server/connections/listener.hpp"

#include <algorithm>
#include <cstring>

#include "server/access/resolve.hpp"
#include "server/connections/unix_socket.hpp"
#include "system/program/sockets.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

}  // namespace

Listener::Listener(const net::any_io_executor& executor, const Endpoint& endpoint)
    : endpoint_(endpoint), acceptor_(executor), name_(to_string(endpoint)) {
  if (const auto* address = std::get_if<TcpAddress>(&endpoint.address)) {
    listen(*address);
  } else {
    listen(std::get<UnixAddress>(endpoint.address));
  }
  describe();
}

Listener::Listener(const net::any_io_executor& executor, const Endpoint& endpoint,
                   const InheritedSocket& inherited)
    : endpoint_(endpoint), acceptor_(executor) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(inherited.descriptor, reinterpret_cast<sockaddr*>(&address), &size);
  acceptor_.assign(Protocol(address.ss_family, SOCK_STREAM), inherited.descriptor);
  describe();
}

Listener::~Listener() { close(); }

bool Listener::is_loopback() const { return local_ || racebeam::is_loopback(host_); }

std::string Listener::described() const {
  const auto* address = std::get_if<TcpAddress>(&bound_.address);
  return address == nullptr || address->host == host_ ? name_ : name_ + " (" + host_ + ")";
}

std::string Listener::announced(const std::string& host) const {
  Endpoint endpoint = bound_;
  auto* address = std::get_if<TcpAddress>(&endpoint.address);
  if (address != nullptr && net::ip::make_address(host_).is_unspecified()) address->host = host;
  return to_string(endpoint);
}

void Listener::close() {
  error_code ignored;
  acceptor_.close(ignored);
  file_.remove();
}

void Listener::listen(const TcpAddress& address) { bind(resolve(address)); }

void Listener::listen(const UnixAddress& address) {
  bind_unix_socket(address.path, name_, [this](const Protocol::endpoint& endpoint) { bind(endpoint); });
  file_ = UnlinkOnExit(address.path);
}

void Listener::bind(const Protocol::endpoint& endpoint) {
  error_code error;
  acceptor_.open(endpoint.protocol());
  claim_address(static_cast<SocketNumber>(acceptor_.native_handle()));
  acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  if (error == net::error::address_in_use) throw AddressError(name_ + " is in use by another server");
  if (error) throw AddressError("cannot listen on " + name_ + ": " + error.message());
}

// Finds the actual address, also of an inherited socket. Keeps a host name, since a certificate may be for
// it.
void Listener::describe() {
  const Protocol::endpoint here = acceptor_.local_endpoint();
  const auto path = unix_path_of(here);
  local_ = path.has_value();
  const auto* tcp_address = std::get_if<TcpAddress>(&endpoint_.address);
  bound_ = endpoint_;
  bound_.classic = false;
  if (local_) {
    bound_.address = UnixAddress{*path};
  } else {
    tcp::endpoint bound;
    std::memcpy(bound.data(), here.data(), std::min(here.size(), bound.capacity()));
    host_ = bound.address().to_string();
    const bool is_named = tcp_address != nullptr && !is_ip_address(tcp_address->host);
    bound_.address = TcpAddress{is_named ? tcp_address->host : host_, bound.port()};
  }
  name_ = to_string(bound_);
}

}  // namespace racebeam
