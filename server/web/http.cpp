#include "server/web/http.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include <boost/asio.hpp>

#include "server/access/resolve.hpp"
#include "server/operation/log.hpp"
#include "server/web/exchange.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::use_awaitable;
using net::ip::tcp;
using namespace std::chrono_literals;

constexpr std::size_t kMostConnections = 64;
constexpr auto kTimeout = 30s;  // for a request and its response

int open_spare() { return ::open("/dev/null", O_RDONLY | O_CLOEXEC); }

}  // namespace

Http::Http(net::io_context& loop, const TcpAddress& address) : acceptor_(loop), spare_(open_spare()) {
  const tcp::endpoint endpoint = resolve(address);
  error_code error;
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(net::socket_base::reuse_address(true));
  acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  const auto named = [](const TcpAddress& where) { return "http" + to_string(Address(where)).substr(3); };
  if (error) throw AddressError("cannot listen on " + named(address) + ": " + error.message());
  name_ = named({address.host, acceptor_.local_endpoint().port()});
  if (!endpoint.address().is_loopback())
    log_warning(name_ + " can be reached from other machines, which can then read the metrics");
}

Http::~Http() {
  if (spare_ >= 0) ::close(spare_);
}

bool Http::is_loopback() const { return acceptor_.local_endpoint().address().is_loopback(); }

void Http::open(Site site, OnSession on_session) {
  site_ = std::move(site);
  on_session_ = std::move(on_session);
  net::co_spawn(acceptor_.get_executor(), welcome(), net::detached);
}

net::awaitable<void> Http::welcome() {
  for (;;) {
    error_code error;
    tcp::socket socket = co_await acceptor_.async_accept(net::redirect_error(use_awaitable, error));
    if (error == net::error::no_descriptors && make_file_room()) continue;
    if (error) {
      net::steady_timer pause(acceptor_.get_executor(), 100ms);
      co_await pause.async_wait(use_awaitable);
      continue;
    }
    make_room();
    const auto connection = std::make_shared<OpenConnection>(std::move(socket));
    connections_.push_back(connection);
    net::co_spawn(acceptor_.get_executor(), serve(connection),
                  [this, connection](const std::exception_ptr&) { ended(connection); });
  }
}

// Closes the oldest connection, so that idle ones do not keep out others.
void Http::make_room() {
  if (connections_.size() >= kMostConnections) close_oldest();
}

// The server's sessions may have all other files. An operator learns from /healthz that it runs.
bool Http::make_file_room() {
  if (spare_ < 0 && connections_.empty()) return false;
  if (spare_ < 0) {
    close_oldest();
  } else {
    ::close(std::exchange(spare_, -1));
  }
  return true;
}

void Http::ended(const Connection& connection) {
  connections_.remove(connection);
  error_code ignored;
  connection->socket.close(ignored);
  if (spare_ < 0) spare_ = open_spare();
}

void Http::close_oldest() {
  error_code ignored;
  connections_.front()->socket.close(ignored);  // cancels what it waits for
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

// Answers requests until the client closes, times out, sends no valid HTTP, or opens a session.
net::awaitable<void> Http::serve(Connection connection) {
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
    on_session_(socket.release(), std::move(*done.session));
    co_return;
  }
  error_code ignored;
  socket.shutdown(net::socket_base::shutdown_both, ignored);
}

}  // namespace racebeam
