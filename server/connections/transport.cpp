#include "server/connections/transport.hpp"

#include <algorithm>
#include <stdexcept>

#include <boost/asio/ssl.hpp>

#include "system/program/sockets.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;

// Returns the number of bytes. The rest is left to async_write.
std::size_t fill_buffer(Socket& socket, std::string_view text) {
  error_code full;
  return socket.write_some(net::buffer(text), full);
}
std::size_t fill_buffer(TlsStream&, std::string_view) { return 0; }
std::size_t fill_buffer(WebSocket&, std::string_view) { return 0; }

CloseCode close_code(ErrorCode why) {
  if (why == ErrorCode::kStopping) return CloseCode::kGoingAway;
  return why == ErrorCode::kBusy ? CloseCode::kTryAgainLater : CloseCode::kPolicyViolation;
}

}  // namespace

template <typename Stream>
std::string_view send_at_once(Stream& stream, Client& client, std::string_view text) {
  client.begin_sending(text.size());
  const std::size_t count = fill_buffer(stream, text);
  client.sent(count);
  return text.substr(count);
}

template std::string_view send_at_once(Socket&, Client&, std::string_view);
template std::string_view send_at_once(TlsStream&, Client&, std::string_view);
template std::string_view send_at_once(WebSocket&, Client&, std::string_view);

// Sends in pieces. Each piece that is accepted shows that the client still reads.
template <typename Stream>
Task<> send_rest(Stream& stream, Client& client, std::string_view text) {
  constexpr std::size_t kPiece = 1 << 16;
  error_code error;
  for (; !text.empty(); text.remove_prefix(std::min(kPiece, text.size()))) {
    const auto piece = net::buffer(text.data(), std::min(kPiece, text.size()));
    co_await net::async_write(stream, piece, net::redirect_error(use_task, error));
    if (client.ending()) throw std::runtime_error("closed, it did not read: " + client.reason());
    if (error) throw std::runtime_error("the client stopped reading");
    client.sent(piece.size());
  }
}

template Task<> send_rest(Socket&, Client&, std::string_view);
template Task<> send_rest(TlsStream&, Client&, std::string_view);

Task<> send_rest(WebSocket& stream, Client& client, std::string_view text) {
  co_await stream.write(text, [&client](std::size_t count) { client.sent(count); });
}

template <typename Stream>
Task<std::size_t> receive(Stream& stream, Client& client, std::span<char> space) {
  error_code error;
  const std::size_t count = co_await stream.async_read_some(net::buffer(space.data(), space.size()),
                                                            net::redirect_error(use_task, error));
  client.received(count);
  co_return count;
}

template Task<std::size_t> receive(Socket&, Client&, std::span<char>);
template Task<std::size_t> receive(TlsStream&, Client&, std::span<char>);

Task<std::size_t> receive(WebSocket& stream, Client& client, std::span<char> space) {
  const std::size_t count = co_await stream.read(space);
  client.received(count);
  co_return count;
}

template <typename Stream>
Task<> send_farewell(Stream& stream, Client& client) {
  error_code ignored;
  co_await net::async_write(stream, net::buffer(client.farewell()), net::redirect_error(use_task, ignored));
  throw std::runtime_error("closed: " + client.reason());
}

template Task<> send_farewell(Socket&, Client&);
template Task<> send_farewell(TlsStream&, Client&);

Task<> send_farewell(WebSocket& stream, Client& client) {
  std::string_view line = client.farewell();
  line.remove_suffix(1);  // LF
  co_await stream.leave(line, close_code(client.code()));
  throw std::runtime_error("closed: " + client.reason());
}

void limit_line(WebSocket& stream, std::size_t bytes) { stream.limit_message(bytes + 2); }

void acknowledge(Socket& socket) { acknowledge_at_once(static_cast<SocketNumber>(socket.native_handle())); }

}  // namespace racebeam
