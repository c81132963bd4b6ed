#include "server/connections/http.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "server/access/resolve.hpp"
#include "server/operation/log.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
namespace http = boost::beast::http;
using boost::system::error_code;
using net::use_awaitable;
using net::ip::tcp;
using namespace std::chrono_literals;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr std::size_t kMostConnections = 64;
constexpr std::uint64_t kLargestBody = 1024;
constexpr auto kPrometheusText = "text/plain; version=0.0.4; charset=utf-8";

struct Page {
  http::status status;
  std::string text;
};

Page page_of(const Request& request, const HttpPages& pages) {
  const auto path = request.target().substr(0, request.target().find('?'));
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return {http::status::method_not_allowed, "only GET and HEAD\n"};
  if (path == "/healthz") return {http::status::ok, "ok\n"};
  if (path == "/metrics") return {http::status::ok, pages.metrics()};
  if (path != "/readyz") return {http::status::not_found, "accepted are /healthz, /readyz and /metrics\n"};
  if (pages.ready()) return {http::status::ok, "ready\n"};
  return {http::status::service_unavailable, "stopping\n"};
}

Response answer(const Request& request, const HttpPages& pages) {
  Page page = page_of(request, pages);
  Response response{page.status, request.version()};
  response.set(http::field::content_type, kPrometheusText);
  if (page.status == http::status::method_not_allowed) response.set(http::field::allow, "GET, HEAD");
  response.keep_alive(request.keep_alive());
  response.content_length(page.text.size());
  if (request.method() != http::verb::head) response.body() = std::move(page.text);
  return response;
}

}  // namespace

Http::Http(net::io_context& loop, const TcpAddress& address, HttpPages pages)
    : acceptor_(loop), pages_(std::move(pages)) {
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
  net::co_spawn(loop, welcome(), net::detached);
}

net::awaitable<void> Http::welcome() {
  for (;;) {
    error_code error;
    tcp::socket socket = co_await acceptor_.async_accept(net::redirect_error(use_awaitable, error));
    if (error) {
      net::steady_timer pause(acceptor_.get_executor(), 100ms);
      co_await pause.async_wait(use_awaitable);
      continue;
    }
    make_room();
    connections_.push_back(std::make_shared<boost::beast::tcp_stream>(std::move(socket)));
    const Connection connection = connections_.back();
    net::co_spawn(acceptor_.get_executor(), serve(connection),
                  [this, connection](const std::exception_ptr&) { connections_.remove(connection); });
  }
}

// Closes the oldest connection, so that idle ones do not keep out others.
void Http::make_room() {
  if (connections_.size() < kMostConnections) return;
  connections_.front()->close();  // cancels what it waits for
  connections_.pop_front();
}

// Answers requests until the client closes, times out, or sends no valid HTTP.
net::awaitable<void> Http::serve(Connection connection) {
  boost::beast::tcp_stream& stream = *connection;
  boost::beast::flat_buffer buffer;
  error_code error;
  for (bool keep_alive = true; keep_alive;) {
    stream.expires_after(30s);
    http::request_parser<http::string_body> parser;
    parser.body_limit(kLargestBody);
    co_await http::async_read(stream, buffer, parser, net::redirect_error(use_awaitable, error));
    const auto place = std::ranges::find(connections_, connection);
    if (error || place == connections_.end()) break;
    connections_.splice(connections_.end(), connections_, place);
    Response response = answer(parser.get(), pages_);
    keep_alive = response.keep_alive();
    http::response_serializer<http::string_body> serializer(response);
    co_await http::async_write(stream, serializer, net::redirect_error(use_awaitable, error));
    if (error) break;
  }
  stream.socket().shutdown(tcp::socket::shutdown_both, error);
}

}  // namespace racebeam
