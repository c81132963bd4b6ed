// The only source that includes Beast's WebSocket, whose headers take long to compile.
#include "server/web/web_socket.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include <boost/asio.hpp>
#include <boost/beast/websocket.hpp>

#include "server/web/replies.hpp"

namespace racebeam {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

// Beast requires these functions of a stream, besides reading and writing. They leave the connection open:
// its owner closes it.
template <typename Handler>
void async_teardown(beast::role_type, ByteStream& stream, Handler&& handler) {
  net::post(stream.get_executor(), beast::bind_front_handler(std::forward<Handler>(handler), error_code()));
}
void beast_close_socket(ByteStream&) {}

struct WebSocket::Impl {
  explicit Impl(ByteStream below) : lower(below), stream(below) {}

  ByteStream lower;
  websocket::stream<ByteStream, false> stream;  // without compression
  bool closed = false;                          // by the client, or by leave()
  bool owes_end = false;                        // the LF of a line, for which there was no space
  char last = 0;                                // the last byte of the current message
};

namespace {

// A frame from a server (RFC 6455, 5.2), which is not masked. It holds a whole message.
std::string frame(unsigned char opcode, std::string_view payload) {
  constexpr unsigned char kFinal = 0x80;
  constexpr std::size_t kShort = 125;  // the longest payload whose length takes one byte
  std::string text(1, static_cast<char>(kFinal | opcode));
  if (payload.size() > kShort) (text += char{126}) += static_cast<char>(payload.size() >> 8);
  text += static_cast<char>(payload.size() & 0xFF);
  return text += payload;
}

std::string close_payload(CloseCode code) {
  const auto number = static_cast<std::uint16_t>(code);
  return {static_cast<char>(number >> 8), static_cast<char>(number & 0xFF)};
}

void name_server(websocket::response_type& response) { response.set(beast::http::field::server, "racebeam"); }

}  // namespace

WebSocket::WebSocket(ByteStream stream) : impl_(std::make_unique<Impl>(stream)) {
  impl_->stream.set_option(websocket::stream_base::decorator(name_server));
  impl_->stream.auto_fragment(false);
}

WebSocket::~WebSocket() = default;

Task<> WebSocket::accept(const HttpRequest& request) {
  error_code error;
  co_await impl_->stream.async_accept(request, net::redirect_error(use_task, error));
  if (error) throw std::runtime_error("WebSocket handshake failed: " + error.message());
}

void WebSocket::limit_message(std::size_t bytes) { impl_->stream.read_message_max(bytes); }

void WebSocket::on_control(std::function<void()> callback) {
  impl_->stream.control_callback(
      [callback = std::move(callback)](websocket::frame_type, beast::string_view) { callback(); });
}

Task<std::size_t> WebSocket::read(std::span<char> space) {
  Impl& impl = *impl_;
  error_code error;
  std::size_t count = complete_line(space, 0);
  while (count == 0) {
    count = co_await impl.stream.async_read_some(net::buffer(space.data(), space.size()),
                                                 net::redirect_error(use_task, error));
    if (error) break;
    if (impl.stream.got_binary()) {
      co_await leave({}, CloseCode::kUnsupportedData);
      throw std::runtime_error("closed: the client sent a binary message; requests are text");
    }
    if (count > 0) impl.last = space[count - 1];
    if (impl.stream.is_message_done()) {
      impl.owes_end = std::exchange(impl.last, 0) != '\n';
      count = complete_line(space, count);
    }
  }
  const bool cancelled = error == net::error::operation_aborted;
  impl.closed = impl.closed || (error && !cancelled);
  if (error.category() == make_error_code(websocket::error::closed).category() &&
      error != websocket::error::closed) {
    throw std::runtime_error("closed: WebSocket: " + error.message());
  }
  co_return count;
}

// Adds the LF that is owed after `count` bytes, if there is space. Returns how many bytes there are then.
std::size_t WebSocket::complete_line(std::span<char> space, std::size_t count) {
  if (!impl_->owes_end || count == space.size()) return count;
  impl_->owes_end = false;
  space[count] = '\n';
  return count + 1;
}

Task<> WebSocket::write(std::string_view replies, const std::function<void(std::size_t)>& sent) {
  while (!replies.empty()) {
    const CutReply reply = cut_reply(replies);
    co_await send(reply.line, false, sent);
    if (!reply.raw.empty()) co_await send(reply.raw, true, sent);
  }
}

// Sends a message in pieces, each in its own frame.
Task<> WebSocket::send(std::string_view bytes, bool binary, const std::function<void(std::size_t)>& sent) {
  constexpr std::size_t kPiece = 1 << 16;
  impl_->stream.binary(binary);
  for (bool last = false; !last; bytes.remove_prefix(std::min(kPiece, bytes.size()))) {
    const std::string_view piece = bytes.substr(0, kPiece);
    last = piece.size() == bytes.size();
    error_code error;
    co_await impl_->stream.async_write_some(last, net::buffer(piece.data(), piece.size()),
                                            net::redirect_error(use_task, error));
    if (error) throw std::runtime_error("the client stopped reading");
    sent(piece.size());
  }
}

// Beast does not send anything after a read was cancelled, so these frames are written without it.
Task<> WebSocket::leave(std::string_view line, CloseCode code) {
  constexpr unsigned char kTextFrame = 1, kCloseFrame = 8;
  if (std::exchange(impl_->closed, true)) co_return;
  const std::string text =
      (line.empty() ? std::string() : frame(kTextFrame, line)) + frame(kCloseFrame, close_payload(code));
  error_code ignored;
  co_await net::async_write(impl_->lower, net::buffer(text), net::redirect_error(use_task, ignored));
}

}  // namespace racebeam
