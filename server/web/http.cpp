#include "server/web/http.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <utility>

#include <boost/asio.hpp>

#include "server/access/resolve.hpp"
#include "server/operation/log.hpp"
#include "server/scheduling/keep_running.hpp"
#include "server/web/exchange.hpp"
#include "system/program/sockets.hpp"
#include "system/regular_file.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;
using namespace std::chrono_literals;

constexpr std::size_t kMaxConnections = 64;
constexpr auto kTimeout = 30s;  // for a request and its response
constexpr auto kFarewell = 2s;  // for a client to close its end

}  // namespace

Http::Http(net::io_context& loop, const TcpAddress& address)
    : loop_(loop), acceptor_(loop), spare_(open_spare_file()) {
  const tcp::endpoint endpoint = resolve(address);
  error_code error;
  acceptor_.open(endpoint.protocol());
  claim_address(static_cast<SocketNumber>(acceptor_.native_handle()));
  acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  const auto named = [](const TcpAddress& where) { return "http" + to_string(Address(where)).substr(3); };
  if (error) throw AddressError("cannot listen on " + named(address) + ": " + error.message());
  name_ = named({address.host, acceptor_.local_endpoint().port()});
  if (!endpoint.address().is_loopback())
    log_warning(name_ + " can be reached from other machines, which can then read the metrics");
}

Http::~Http() {
  if (spare_ >= 0) close_file(spare_);
}

bool Http::is_loopback() const { return acceptor_.local_endpoint().address().is_loopback(); }

void Http::open(Site site, OnSession on_session) {
  site_ = std::move(site);
  on_session_ = std::move(on_session);
  keep_running(loop_, "accepting clients on " + name_, [this] { return accept_clients(); });
}

Task<> Http::accept_clients() {
  for (;;) {
    error_code error;
    tcp::socket socket = co_await acceptor_.async_accept(net::redirect_error(use_task, error));
    if (error == net::error::no_descriptors) socket = co_await accept_without_files(error);
    if (error) {
      co_await pause(loop_, 100ms);
      if (spare_ < 0) spare_ = open_spare_file();
      continue;
    }
    make_room();
    const auto connection = std::make_shared<OpenConnection>(std::move(socket));
    Task<> serving = serve(connection);
    connections_.push_back(connection);
    try {
      spawn(loop_, std::move(serving));
    } catch (...) {
      remove(connection);
      throw;
    }
  }
}

// A system that has no file for a connection says so even if no client is there. Makes room only for one that
// is.
Task<tcp::socket> Http::accept_without_files(error_code& error) {
  tcp::socket socket(loop_);
  co_await acceptor_.async_wait(net::socket_base::wait_read, net::redirect_error(use_task, error));
  if (!error && !make_file_room()) error = net::error::no_descriptors;
  if (!error) socket = co_await acceptor_.async_accept(net::redirect_error(use_task, error));
  co_return socket;
}

// Closes the oldest connection, so that idle ones do not keep out others.
void Http::make_room() {
  if (connections_.size() >= kMaxConnections) close_oldest();
}

// The server's sessions may have taken all other files. An operator can then still read /healthz.
bool Http::make_file_room() {
  if (spare_ < 0 && connections_.empty()) return false;
  if (spare_ < 0) {
    close_oldest();
  } else {
    close_file(std::exchange(spare_, -1));
  }
  return true;
}

void Http::remove(const Connection& connection) {
  connections_.remove(connection);
  error_code ignored;
  connection->socket.close(ignored);
  if (spare_ < 0) spare_ = open_spare_file();
}

void Http::close_oldest() {
  error_code ignored;
  connections_.front()->socket.close(ignored);  // cancels the operation that the connection waits for
  connections_.pop_front();
}

// Replaces the limit that was set before.
void Http::close_after(std::chrono::seconds limit, const Connection& connection) {
  connection->timeout.expires_after(limit);
  connection->timeout.async_wait([waiting = std::weak_ptr(connection)](error_code cancelled) {
    const Connection late = waiting.lock();
    error_code ignored;
    if (!cancelled && late) late->socket.close(ignored);
  });
}

Task<> Http::serve(Connection connection) {
  try {
    co_await serve_requests(connection);
  } catch (const std::exception&) {
    report_failure(std::current_exception());
  }
  remove(connection);
}

// Answers requests until the client closes, times out, sends invalid HTTP, or opens a session.
Task<> Http::serve_requests(Connection connection) {
  ByteStream::Socket& socket = connection->socket;
  ByteStream stream(socket);
  boost::beast::flat_buffer buffer;
  Exchange done;
  done.open = true;
  while (done.open) {
    close_after(kTimeout, connection);
    done = co_await exchange(stream, buffer, site_);
    const auto place = std::ranges::find(connections_, connection);
    if (place == connections_.end()) co_return;
    connections_.splice(connections_.end(), connections_, place);
  }
  connection->timeout.cancel();
  if (done.session) {
    on_session_(std::move(socket), std::move(*done.session));
    co_return;
  }
  co_await drain(connection);
}

// Closing a socket with unread input would make the system discard a reply that the client has not read yet.
Task<> Http::drain(Connection connection) {
  ByteStream::Socket& socket = connection->socket;
  error_code error;
  socket.shutdown(net::socket_base::shutdown_send, error);
  close_after(kFarewell, connection);
  std::array<char, 4096> rest;
  while (!error) co_await socket.async_read_some(net::buffer(rest), net::redirect_error(use_task, error));
}

}  // namespace racebeam
