#include "server/web/exchange.hpp"

#include <boost/asio.hpp>
#include <boost/beast/http.hpp>

namespace racebeam {
namespace {

namespace net = boost::asio;
namespace http = boost::beast::http;
using net::use_awaitable;

constexpr std::uint64_t kLargestBody = 1024;

}  // namespace

net::awaitable<Exchange> exchange(ByteStream& stream, boost::beast::flat_buffer& buffer, const Site& site) {
  boost::system::error_code error;
  Exchange done;
  http::request_parser<http::string_body> parser;
  parser.body_limit(kLargestBody);
  co_await http::async_read(stream, buffer, parser, net::redirect_error(use_awaitable, error));
  if (error) co_return done;
  auto response = answer(parser.get(), site);
  if (!response) {
    // A client speaks first again after the server has accepted.
    if (buffer.size() == 0) done.session = parser.release();
    co_return done;
  }
  http::response_serializer<http::string_body> serializer(*response);
  co_await http::async_write(stream, serializer, net::redirect_error(use_awaitable, error));
  done.open = !error && response->keep_alive();
  co_return done;
}

}  // namespace racebeam
