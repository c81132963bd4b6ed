#include "server/web/exchange.hpp"

#include <boost/asio.hpp>
#include <boost/beast/http.hpp>

namespace racebeam {
namespace {

namespace net = boost::asio;
namespace http = boost::beast::http;
using boost::system::error_code;
using http::status;

using Parser = http::request_parser<http::string_body>;

constexpr std::uint64_t kLargestBody = 1024;
constexpr std::uint32_t kLongestHeader = 8192;

// Whether the client waits for "100 Continue" before it sends the body of its request (RFC 9110, 10.1.1).
bool expects_continue(const HttpRequest& request) {
  return boost::beast::iequals(request[http::field::expect], "100-continue");
}

Task<> send(ByteStream& stream, const HttpResponse& response, error_code& error) {
  http::response_serializer<http::string_body> serializer(response);
  co_await http::async_write(stream, serializer, net::redirect_error(use_task, error));
}

// Does not read a body in chunks: some bodies make an assertion of Boost.Beast 1.74 fail at their end.
Task<> receive(ByteStream& stream, boost::beast::flat_buffer& buffer, Parser& parser, error_code& error) {
  parser.body_limit(kLargestBody);
  parser.header_limit(kLongestHeader);
  co_await http::async_read_header(stream, buffer, parser, net::redirect_error(use_task, error));
  if (error || parser.chunked()) co_return;
  if (expects_continue(parser.get()))
    co_await send(stream, HttpResponse{status::continue_, parser.get().version()}, error);
  if (!error) co_await http::async_read(stream, buffer, parser, net::redirect_error(use_task, error));
}

// The response to a request that cannot be read; nothing: the client has gone.
std::optional<HttpResponse> refusal(const error_code& error) {
  if (error == http::error::header_limit)
    return refuse(status::request_header_fields_too_large,
                  "the header is longer than " + std::to_string(kLongestHeader) + " bytes");
  if (error == http::error::body_limit)
    return refuse(status::payload_too_large,
                  "the body is longer than " + std::to_string(kLargestBody) + " bytes");
  const bool is_end = error == http::error::end_of_stream || error == http::error::partial_message;
  if (is_end || error.category() != make_error_code(http::error::end_of_stream).category())
    return std::nullopt;
  return refuse(status::bad_request, "this is not HTTP: " + error.message());
}

std::optional<HttpResponse> refusal_of_chunks() {
  return refuse(status::length_required,
                "a body in chunks is not accepted; give its length as Content-Length");
}

}  // namespace

Task<Exchange> exchange(ByteStream& stream, boost::beast::flat_buffer& buffer, const Site& site) {
  error_code error;
  Exchange done;
  Parser parser;
  co_await receive(stream, buffer, parser, error);
  const bool is_read = !error && !parser.chunked();
  auto response = error ? refusal(error) : is_read ? answer(parser.get(), site) : refusal_of_chunks();
  if (error && !response) co_return done;
  if (!response) {
    // A client must not send anything after its request until the server has accepted it.
    if (buffer.size() == 0) done.session = parser.release();
    co_return done;
  }
  const bool stays = is_read && response->keep_alive();
  error = {};
  co_await send(stream, *response, error);
  done.open = stays && !error;
  co_return done;
}

}  // namespace racebeam
