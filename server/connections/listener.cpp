#include "server/connections/listener.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "server/access/resolve.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using net::ip::tcp;
using Unix = net::local::stream_protocol;
using boost::system::error_code;

// A socket file remains after its server has died, and refuses connections.
void remove_stale(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) return;
  if (!std::filesystem::is_socket(path)) throw AddressError(path + " exists, but is not a socket");
  net::io_context context;
  error_code error;
  Unix::socket probe(context, Unix());
  probe.non_blocking(true);  // a busy server has a full queue, for which connect() would wait
  probe.connect(Unix::endpoint(path), error);
  if (error == net::error::connection_refused) std::filesystem::remove(path);
}

// A lock on the folder of a socket. A server that has bound its socket and does not listen yet looks dead;
// others that hold the lock do not take its file.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : folder_(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (::flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK &&
           std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(kBetweenTries);
  }
  ~FolderLock() {
    if (folder_ >= 0) ::close(folder_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  // Something else may hold the lock for long, and a folder may lack one: the server then goes on without.
  static constexpr std::chrono::seconds kPatience{2};
  static constexpr std::chrono::milliseconds kBetweenTries{5};

  const int folder_;
};

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
  constexpr std::size_t kLongestPath = sizeof(sockaddr_un::sun_path) - 1;
  if (address.path.size() > kLongestPath) {
    throw AddressError(name_ + " is too long; a socket's path has at most " + std::to_string(kLongestPath) +
                       " bytes");
  }
  const FolderLock lock(std::filesystem::path(address.path).parent_path());
  remove_stale(address.path);
  bind(Unix::endpoint(address.path));
  file_ = UnlinkOnExit(address.path);
}

void Listener::bind(const Protocol::endpoint& endpoint) {
  error_code error;
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(net::socket_base::reuse_address(true));
  acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  if (error == net::error::address_in_use) throw AddressError(name_ + " is in use by another server");
  if (error) throw AddressError("cannot listen on " + name_ + ": " + error.message());
}

// Finds the actual address, also of an inherited socket. A host name stays: a certificate may be for it.
void Listener::describe() {
  const Protocol::endpoint here = acceptor_.local_endpoint();
  local_ = here.protocol().family() == AF_UNIX;
  const auto* tcp_address = std::get_if<TcpAddress>(&endpoint_.address);
  bound_ = endpoint_;
  bound_.classic = false;
  if (local_) {
    const auto* address = static_cast<const sockaddr_un*>(static_cast<const void*>(here.data()));
    bound_.address = UnixAddress{address->sun_path};
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
