#include "server/connections/connection_acceptor.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "server/connections/lingering_close.hpp"
#include "server/operation/log.hpp"
#include "server/scheduling/keep_running.hpp"
#include "system/program/sockets.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using namespace std::chrono_literals;

// The buffer of a Unix socket does not grow by itself, as that of TCP does. A buffer that is smaller than a
// reply costs the client and the server a wakeup each time it is full.
void set_options(Socket& socket) {
  constexpr int kUnixBuffer = 1 << 20;  // the system may give less
  error_code is_unix, ignored;
  socket.set_option(net::ip::tcp::no_delay(true), is_unix);
  if (is_unix) socket.set_option(net::socket_base::send_buffer_size(kUnixBuffer), ignored);
  socket.set_option(net::socket_base::keep_alive(true), ignored);
  socket.non_blocking(true, ignored);
}

// Gives the descriptor to the socket, or closes it.
void take_over(Socket& socket, Socket::native_handle_type descriptor) {
  sockaddr_storage here{};
  socklen_t size = sizeof here;
  ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&here), &size);
  try {
    socket.assign(Protocol(here.ss_family, SOCK_STREAM), descriptor);
  } catch (const std::exception&) {
    close_socket(static_cast<SocketNumber>(descriptor));
    throw;
  }
}

// Moves the socket to another loop. Returns false if the system cannot do that, as Wine 8 cannot; the socket
// then stays.
bool has_moved(Socket& socket, Loop& loop) {
  error_code error;
  const auto descriptor = socket.release(error);
  if (error) return false;
  Socket moved(loop.context);
  take_over(moved, descriptor);
  socket = std::move(moved);
  return true;
}

constexpr auto kReliefTimeout = 800ms;  // how long a client that comes when memory is short may wait
constexpr auto kBetweenChecks = 20ms;   // of whether there is memory for it
constexpr int kMaxWaiting = 64;

// Counts a client that waits for memory, during its lifetime.
class Waiting {
 public:
  explicit Waiting(int& count) : count_(++count) {}
  ~Waiting() { --count_; }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

 private:
  int& count_;
};

bool has_memory_for_one_more(const Service& service) {
  constexpr std::uint64_t kSession = 1 << 20;
  const auto& memory = memory_of(service);
  return !memory || memory->has(kSession);
}

// Returns how many bytes the transport of a session takes, from the first byte of a handshake on. The numbers
// are measured. The session itself counts its other memory.
std::size_t carrier_bytes(const Endpoint& endpoint) {
  constexpr std::size_t kSocket = std::size_t{4} << 10, kTls = std::size_t{96} << 10,
                        kHttp = std::size_t{16} << 10;
  return kSocket + (endpoint.tls ? kTls : 0) + (endpoint.web ? kHttp : 0);
}

// Returns the error for a client that is refused, in its protocol. It is empty for the classic protocol,
// which does not have errors, and over TLS, where the handshake has not taken place.
std::string refusal(const Endpoint& endpoint, const Client& client) {
  if (endpoint.classic || endpoint.tls) return {};
  return endpoint.web ? http_refusal(client.reason()) : client.farewell();
}

// The address of a client that has disconnected already is unknown.
std::string source_of(const Socket& socket) {
  error_code ignored;
  const Protocol::endpoint peer = socket.remote_endpoint(ignored);
  net::ip::tcp::endpoint address;
  std::memcpy(address.data(), peer.data(), std::min(peer.size(), address.capacity()));
  return WrongTokens::source_of(address.address());
}

}  // namespace

ConnectionAcceptor::ConnectionAcceptor(const ServerSettings& settings, const Services& services,
                                       AccessControl& access, Loops& loops, Metrics& metrics)
    : settings_(settings), services_(services), access_(access), loops_(loops), metrics_(metrics) {
  for (const Endpoint& endpoint : settings.endpoints) {
    if (const auto* inherited = std::get_if<InheritedAddress>(&endpoint.address)) {
      listen_inherited(endpoint, inherited->name);
    } else if (!is_stream(endpoint.address)) {
      listen(endpoint);
    }
  }
}

void ConnectionAcceptor::listen(const Endpoint& endpoint) {
  check(listeners_.emplace_back(loops_.first().context.get_executor(), endpoint));
}

void ConnectionAcceptor::listen_inherited(const Endpoint& endpoint, const std::string& name) {
  bool found = false;
  for (const InheritedSocket& socket : inherited_sockets()) {
    if (!name.empty() && socket.name != name) continue;
    if (!taken_.insert(socket.descriptor).second)
      throw std::runtime_error("two addresses select the socket '" + socket.name +
                               "' of systemd; name it once");
    check(listeners_.emplace_back(loops_.first().context.get_executor(), endpoint, socket));
    found = true;
  }
  if (found) return;
  const std::string which = name.empty() ? "socket" : "socket named '" + name + "'";
  throw std::runtime_error("systemd did not pass a " + which +
                           " (LISTEN_FDS, LISTEN_FDNAMES); start the unit's socket, not its service");
}

void ConnectionAcceptor::check(const Listener& listener) const {
  const std::string& name = listener.name();
  if (listener.endpoint().tls && !access_.tls())
    throw std::runtime_error(name + " needs --tls-cert and --tls-key");
  if (listener.is_loopback()) return;
  if (listener.endpoint().classic) {
    throw std::runtime_error(name +
                             " can be reached from other machines, but the classic protocol has no "
                             "tokens; use 127.0.0.1, or the line protocol");
  }
  if (!access_.requires_token()) {
    throw std::runtime_error(name +
                             " can be reached from other machines: give --token-file or --announce, so that "
                             "clients need a token, or listen on 127.0.0.1");
  }
  if (!listener.endpoint().tls) {
    log_warning(name +
                " can be reached from other machines, without TLS: tokens can be read from the packets, and "
                "used by others; tls:// and --tls-cert encrypt");
  }
}

// Permissions of the file system protect a Unix socket.
const Service& ConnectionAcceptor::service_of(const Listener& listener) const {
  if (listener.endpoint().classic) return *services_.classic;
  return listener.is_local() ? *services_.line : access_.guarded();
}

std::vector<std::string> ConnectionAcceptor::names() const {
  std::vector<std::string> all;
  for (const Listener& listener : listeners_) all.push_back(listener.full_name());
  return all;
}

std::vector<std::string> ConnectionAcceptor::announced(const std::string& host) const {
  std::vector<std::string> all;
  for (const Listener& listener : listeners_) {
    if (!listener.endpoint().classic) all.push_back(listener.announced(host));
  }
  return all;
}

void ConnectionAcceptor::open(int most_connections) {
  max_connections_ = std::min(most_connections, settings_.max_connections);
  for (Listener& listener : listeners_) {
    keep_running(loops_.first().context, "accepting clients on " + listener.name(),
                 [this, &listener] { return accept_clients(listener); });
    log("listening on " + listener.described(), {{"event", "listening"}, {"address", listener.full_name()}});
  }
}

void ConnectionAcceptor::close() {
  closed_ = true;
  for (Listener& listener : listeners_) listener.close();
}

Task<> ConnectionAcceptor::accept_clients(Listener& listener) {
  bool failed = false;  // the last attempt failed, and the log says so
  while (!closed_) {
    Loop& loop = loops_.least_loaded();
    error_code error;
    Socket socket =
        co_await listener.acceptor().async_accept(loop.context, net::redirect_error(use_task, error));
    if (closed_) break;
    if (error) {  // most likely, the process is out of descriptors for a while
      if (!std::exchange(failed, true))
        log_warning("cannot take a client on " + listener.name() + ": " + error.message());
      co_await pause(loops_.first().context, 100ms);
      continue;
    }
    failed = false;
    set_options(socket);
    admit(std::move(socket), loop, listener);
  }
}

// If there are too many sessions, closes the oldest one without a token. That session ends as soon as its
// loop handles the event.
std::optional<std::string> ConnectionAcceptor::reason_to_refuse(const Service& service) {
  if (!has_memory_for_one_more(service)) return "the server's sessions hold all the memory that they may";
  if (loops_.sessions() > max_connections_) return "the server may open no more files";
  if (metrics_.sessions_open < settings_.max_sessions) return std::nullopt;
  const std::string full =
      "there are " + std::to_string(settings_.max_sessions) + " sessions, the limit of this server";
  if (!lobby_->make_room(full + "; those without a token go first")) return full;
  ++metrics_.ended_busy;
  return std::nullopt;
}

void ConnectionAcceptor::admit(Socket socket, Loop& loop, Listener& listener) {
  const Endpoint& endpoint = listener.endpoint();
  std::string name = listener.name() + " client " + std::to_string(listener.count_client());
  Carrier carrier;
  if (endpoint.tls) carrier.tls = access_.tls()->context();
  if (endpoint.web) carrier.site = &access_.site();
  const Service& service = service_of(listener);
  admit_when_memory_allows(std::make_shared<Client>(std::move(socket), loop, std::move(name),
                                                    memory_of(service), carrier_bytes(endpoint)),
                           service, std::move(carrier), endpoint);
}

void ConnectionAcceptor::admit_over_http(Socket socket, HttpRequest request, const std::string& address) {
  Loop& least_loaded = loops_.least_loaded();
  Loop& loop = has_moved(socket, least_loaded) ? least_loaded : loops_.first();
  set_options(socket);
  std::string name = address + " client " + std::to_string(++from_http_);
  const Endpoint endpoint{TcpAddress(), false, false, true};
  const Service& service = access_.guarded();
  admit_when_memory_allows(std::make_shared<Client>(std::move(socket), loop, std::move(name),
                                                    memory_of(service), carrier_bytes(endpoint)),
                           service, Carrier{nullptr, &access_.site(), std::move(request)}, endpoint);
}

void ConnectionAcceptor::admit_when_memory_allows(std::shared_ptr<Client> client, const Service& service,
                                                  Carrier carrier, const Endpoint& endpoint) {
  if (has_memory_for_one_more(service) || waiting_ >= kMaxWaiting)
    admit(std::move(client), service, std::move(carrier), endpoint);
  else
    spawn(loops_.first().context,
          admit_after_relief(std::move(client), service, std::move(carrier), endpoint));
}

// IdleMonitor ends sessions that hold much memory at its second check. Clients that come meanwhile wait for
// that.
Task<> ConnectionAcceptor::admit_after_relief(std::shared_ptr<Client> client, const Service& service,
                                              Carrier carrier, Endpoint endpoint) {
  const Waiting place(waiting_);
  const auto end = client->connected_at() + kReliefTimeout;
  while (!has_memory_for_one_more(service) && Clock::now() < end)
    co_await pause(loops_.first().context, kBetweenChecks);
  if (!closed_) admit(std::move(client), service, std::move(carrier), endpoint);
}

void ConnectionAcceptor::admit(std::shared_ptr<Client> client, const Service& service, Carrier carrier,
                               const Endpoint& endpoint) {
  auto& context = client->loop.context;
  if (const auto why = reason_to_refuse(service)) {
    ++metrics_.refused_busy;
    log_warning(client->name + ": refused, " + *why);
    client->end(ErrorCode::kBusy, *why + "; try again later");
    std::string text = refusal(endpoint, *client);
    const bool lingering = loops_.sessions() <= max_connections_;
    spawn(context, refuse_connection(std::move(client), std::move(text), lingering));
    return;
  }
  client->open.emplace(metrics_.sessions_open);
  if (endpoint.classic) ++metrics_.sessions_classic;
  if (!endpoint.classic && !endpoint.web) ++metrics_.sessions_line;  // over HTTP, a session begins later
  if (access_.guards(service)) {
    client->token_attempts.emplace(access_.wrong_tokens(), source_of(client->socket));
    lobby_->enter(client);
  }
  spawn(context, serve_connection(std::move(client), service, std::move(carrier), metrics_));
}

}  // namespace racebeam
