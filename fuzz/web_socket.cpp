// The frames that a client sends over a WebSocket. The first byte says how the input is cut the second time,
// and how much the server reads at a time.
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include <boost/beast/http/field.hpp>
#include <boost/beast/http/verb.hpp>

#include "fuzz/support/connection.hpp"
#include "fuzz/support/target.hpp"
#include "server/web/replies.hpp"
#include "server/web/web_socket.hpp"

namespace racebeam::fuzz {
namespace {

constexpr std::size_t kLongestMessage = 4096;
constexpr std::string_view kGoodbye = "error stopping the fuzzer leaves";

HttpRequest handshake() {
  using boost::beast::http::field;
  HttpRequest request{boost::beast::http::verb::get, "/session", 11};
  request.set(field::host, "127.0.0.1");
  request.set(field::upgrade, "websocket");
  request.set(field::connection, "Upgrade");
  request.set(field::sec_websocket_version, "13");
  request.set(field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
  return request;
}

struct Outcome {
  std::string lines;    // that the server has read
  std::string refusal;  // of what breaks the protocol; empty: nothing did
  std::string answers;  // frames of the server
  bool has_ended = false;
};

// Reads until the client closes, and answers each line with the same line.
Task<> converse(ByteStream stream, const HttpRequest& request, std::size_t space, Outcome& outcome) {
  WebSocket socket(stream);
  socket.limit_message(kLongestMessage);
  std::size_t pings = 0;
  socket.on_control([&] { ++pings; });
  try {
    co_await socket.accept(request);
    std::string part(space, '\0');
    while (const std::size_t count = co_await socket.read(part)) outcome.lines.append(part, 0, count);
    co_await socket.leave(kGoodbye, CloseCode::kGoingAway);
  } catch (const std::runtime_error& refusal) {
    outcome.refusal = refusal.what();
  }
  outcome.has_ended = true;
}

Outcome outcome_of(std::string_view frames, std::size_t space, std::size_t piece) {
  static const HttpRequest request = handshake();
  Outcome outcome;
  Connection connection;
  connection.serve(converse(ByteStream(connection.socket()), request, space, outcome));
  require(connection.answers().starts_with("HTTP/1.1 101 "), "a handshake is accepted", connection.answers());
  connection.forget_answers();
  connection.say(frames, piece);
  connection.end();
  outcome.answers = connection.answers();
  return outcome;
}

// A server's frames are not masked, and whole: opcode, length, payload.
void check_frames(std::string_view frames) {
  constexpr std::string_view kLengths = "\x7E\x7F";
  while (!frames.empty()) {
    require(frames.size() >= 2 && (frames[0] & 0x80) != 0 && (frames[1] & 0x80) == 0 &&
                kLengths.find(frames[1]) == std::string_view::npos,
            "the server sends short frames, which are whole");
    const std::size_t size = 2 + static_cast<std::size_t>(frames[1]);
    require(size <= frames.size(), "a frame has the length that it names");
    frames.remove_prefix(size);
  }
}

void check(const Outcome& outcome) {
  require(outcome.has_ended, "a conversation ends when the client has ended");
  require(is_printable(outcome.refusal), "a refusal is a printable sentence", outcome.refusal);
  check_frames(outcome.answers);
}

}  // namespace

void run(Bytes input) {
  Reader reader(input);
  const unsigned first = reader.byte();
  const std::string_view frames = text_of(reader.rest());
  const Outcome whole = outcome_of(frames, kLongestMessage, std::max<std::size_t>(frames.size(), 1));
  const Outcome cut = outcome_of(frames, 1 + (first >> 4), 1 + (first & 15));
  check(whole);
  check(cut);
  require(whole.refusal == cut.refusal, "what is refused does not depend on cuts",
          whole.refusal + "\n" + cut.refusal);
  const auto [shorter, longer] =
      std::minmax(whole.lines, cut.lines, [](const auto& a, const auto& b) { return a.size() < b.size(); });
  require(longer.starts_with(shorter), "what is read does not depend on cuts", shorter);
  if (whole.refusal.empty())
    require(longer == shorter, "all that is not refused is read, however it is cut", longer);
}

}  // namespace racebeam::fuzz
