#include "server/connections/connection.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <boost/asio/ssl.hpp>

#include "server/connections/departure.hpp"
#include "server/connections/session_loop.hpp"
#include "server/operation/log.hpp"
#include "server/scheduling/keep_running.hpp"
#include "server/web/exchange.hpp"
#include "server/web/web_socket.hpp"
#include "system/program/sockets.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using namespace std::chrono_literals;
using TlsStream = net::ssl::stream<Socket&>;

// Sends at once what fits into the socket's buffer. A short reply then takes one system call, and does not
// wait for the event loop. The rest is left to async_write.
std::size_t send_at_once(Socket& socket, std::string_view text) {
  error_code full;
  return socket.write_some(net::buffer(text), full);
}
std::size_t send_at_once(TlsStream&, std::string_view) { return 0; }
std::size_t send_at_once(WebSocket&, std::string_view) { return 0; }

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

Task<> send_rest(WebSocket& stream, Client& client, std::string_view text) {
  co_await stream.write(text, [&client](std::size_t count) { client.sent(count); });
}

// Receives bytes. Returns their number; 0: there will be no more.
template <typename Stream>
Task<std::size_t> receive(Stream& stream, Client& client, std::span<char> space) {
  error_code error;
  const std::size_t count = co_await stream.async_read_some(net::buffer(space.data(), space.size()),
                                                            net::redirect_error(use_task, error));
  client.received(count);
  co_return count;
}

Task<std::size_t> receive(WebSocket& stream, Client& client, std::span<char> space) {
  const std::size_t count = co_await stream.read(space);
  client.received(count);
  co_return count;
}

// Sends the last error when the server ends the session.
template <typename Stream>
Task<> take_leave(Stream& stream, Client& client) {
  error_code ignored;
  co_await net::async_write(stream, net::buffer(client.farewell()), net::redirect_error(use_task, ignored));
  throw std::runtime_error("closed: " + client.reason());
}

CloseCode close_code(ErrorCode why) {
  if (why == ErrorCode::kStopping) return CloseCode::kGoingAway;
  return why == ErrorCode::kBusy ? CloseCode::kTryAgainLater : CloseCode::kPolicyViolation;
}

Task<> take_leave(WebSocket& stream, Client& client) {
  std::string_view line = client.farewell();
  line.remove_suffix(1);  // LF
  co_await stream.leave(line, close_code(client.code()));
  throw std::runtime_error("closed: " + client.reason());
}

// A message may be as long as the longest line and its end.
template <typename Stream>
void limit_message(Stream&, const LineSession&) {}
void limit_message(WebSocket& stream, const LineSession& session) {
  stream.limit_message(session.longest_line() + 2);
}

// A client that writes a request in pieces may delay the next one until this one is acknowledged (Nagle's
// algorithm). The system delays acknowledgements by 40 ms.
void acknowledge(Socket& socket) { acknowledge_at_once(static_cast<SocketNumber>(socket.native_handle())); }

// Delays the answer to a wrong token, and the requests that the client has sent after it. Returns early if
// the session is to end.
Task<> hold_back(Client& client, WrongTokens::Delay delay) {
  constexpr WrongTokens::Delay kBetweenLooks = 100ms;
  for (const auto end = Clock::now() + delay; Clock::now() < end && !client.ending();)
    co_await pause(client.loop.context, std::min(delay, kBetweenLooks));
}

// Returns for how long the answer is delayed.
WrongTokens::Delay judge(Client& client, const LineSession& session, Metrics& metrics) {
  const auto [more, in_a_row, delay] = client.guesser->update(session.wrong_tokens());
  metrics.wrong_tokens += more;
  if (more > 0) {
    log_warning(client.name + ": a wrong token from " + client.guesser->source() + ", number " +
                    std::to_string(in_a_row) + " in a row",
                {{"client", client.name}, {"event", "wrong-token"}, {"address", client.guesser->source()}});
  }
  if (session.admitted()) {
    client.guesser->admitted();
    client.guesser.reset();
    client.place.reset();
  }
  return delay;
}

void count_admission(Client& client, Metrics& metrics) {
  if (std::exchange(client.admitted, true)) return;
  client.admitted_open.emplace(metrics.admitted_open);
  ++metrics.admitted;
}

// Waits for the session's turn on its loop.
Task<> take_turn(Client& client) {
  client.working = true;
  co_await client.loop.turns.wait(client.loop.context, client.usage);
  client.working = false;
}

// Works until the session has a reply or needs input.
Task<> work(Client& client, PacedClassic& session) {
  Turns& turns = client.loop.turns;
  Departure departure;
  for (bool done = false; !done;) {
    if (!turns.may_work(client.usage)) co_await take_turn(client);
    if (client.ending()) throw std::runtime_error("closed: " + client.reason());
    done = session.work(turns.slice());
    turns.worked(client.usage, session.worked());
    if (!done && departure.has_gone(client.socket))
      throw std::runtime_error("the client left in the middle of an act");
  }
}

template <typename Stream>
Task<> serve_connection(Stream& stream, Client& client, PacedClassic& session, Metrics&) {
  error_code error;
  bool piece = false;  // everything that was received last is part of a line
  while (!session.ended()) {
    co_await work(client, session);
    if (const auto text = session.reply()) {
      co_await net::async_write(stream, net::buffer(*text), net::redirect_error(use_task, error));
      client.sent(text->size());
      client.loop.meter.frames.add(session.take_frames());
      piece = false;
      if (error && !session.ended()) throw std::runtime_error("the client stopped reading");
    } else {
      if (piece) acknowledge(client.socket);
      session.received(co_await receive(stream, client, session.space()));
      piece = true;
    }
    if (client.ending()) throw std::runtime_error("closed: " + client.reason());
  }
}

// Waits for the time in which a recording writes a few frames. Its queue holds more frames, so it does not
// run empty.
Task<> await_recording(Client& client) {
  client.working = true;
  co_await pause(client.loop.context, 1ms);
  client.working = false;
}

// `piece`: everything that was received last is part of a line.
template <typename Stream>
Task<> read(Stream& stream, Client& client, LineSession& session, bool piece) {
  if (piece) acknowledge(client.socket);
  limit_message(stream, session);
  const std::size_t count = co_await receive(stream, client, session.space());
  if (count > 0 || !client.ending()) session.received(count);
}

// Between two slices of a long request, or of many requests that were sent ahead, other sessions of the loop
// get their turn. Requests that were sent ahead are split further: each part ends when its replies are sent.
template <typename Stream>
Task<> serve_connection(Stream& stream, Client& client, LineSession& session, Metrics& metrics) {
  using Next = SessionLoop::Next;
  Departure departure;
  Turns& turns = client.loop.turns;
  SessionLoop loop(session);
  const auto run = [&] {
    const bool more = session.run(turns.slice());
    turns.worked(client.usage, session.worked());
    return more;
  };
  bool piece = false;
  for (;;) {
    if (!turns.may_work(client.usage)) co_await take_turn(client);
    if (client.ending()) co_await take_leave(stream, client);
    Next next = loop.work(run);
    if (session.admitted()) count_admission(client, metrics);
    if (client.guesser) co_await hold_back(client, judge(client, session, metrics));
    const bool sends = next == Next::kSend;
    if (sends) {
      const std::string_view text = loop.output();
      client.begin_sending(text.size());
      const std::size_t count = send_at_once(stream, text);
      client.sent(count);
      if (count < text.size()) co_await send_rest(stream, client, text.substr(count));
      next = loop.sent();
      piece = false;
    }
    if (next == Next::kDone) break;
    if (next == Next::kRead) {
      if (!client.ending()) co_await read(stream, client, session, std::exchange(piece, true));
    } else if (!sends && departure.has_gone(client.socket)) {
      throw std::runtime_error("the client left in the middle of a request");
    } else if (next == Next::kPause) {
      co_await await_recording(client);
    }
  }
}

// Limits how long a client may take to close its end.
class Patience {
 public:
  explicit Patience(const std::shared_ptr<Client>& client) : timer_(client->socket.get_executor(), 2s) {
    timer_.async_wait([client](error_code cancelled) {
      error_code ignored;
      if (!cancelled) client->socket.close(ignored);
    });
  }

 private:
  net::steady_timer timer_;
};

// Closing a socket with unread input would make the system discard output that the client has not read yet.
Task<> close_gently(std::shared_ptr<Client> client) {
  error_code error;
  client->socket.shutdown(Socket::shutdown_send, error);
  const Patience patience(client);
  std::array<char, 4096> rest;
  while (!error) {
    co_await client->socket.async_read_some(net::buffer(rest), net::redirect_error(use_task, error));
  }
}

// Releases a session's caches in a pause, during the lifetime of the session.
class Resting {
 public:
  Resting(Client& client, std::function<void()> rest) : client_(client) { client_.on_rest = std::move(rest); }
  ~Resting() { client_.on_rest = nullptr; }
  Resting(const Resting&) = delete;
  Resting& operator=(const Resting&) = delete;

 private:
  Client& client_;
};

// A session of the classic protocol. It may leave thousands of saved states, which `disposal` destroys.
class ClassicPlace {
 public:
  ClassicPlace(const ClassicService& service, const std::shared_ptr<MemoryBudget>& memory)
      : disposal_(service.disposal), session_(std::make_unique<PacedClassic>(service, memory)) {}
  ~ClassicPlace() {
    session_->leave();
    const std::size_t bytes = session_->bytes();
    dispose(disposal_, nullptr, bytes, std::move(session_));
  }
  ClassicPlace(const ClassicPlace&) = delete;
  ClassicPlace& operator=(const ClassicPlace&) = delete;

  PacedClassic& session() { return *session_; }

 private:
  const std::shared_ptr<Disposal> disposal_;
  std::unique_ptr<PacedClassic> session_;
};

template <typename Stream>
Task<> play(Stream& stream, Client& client, const ClassicService& service, Metrics& metrics) {
  count_admission(client, metrics);
  ClassicPlace place(service, client.memory());
  PacedClassic& session = place.session();
  co_await work(client, session);
  session.check_machine();
  log(client.name + ": " + describe(session.machine()), {{"client", client.name}, {"event", "came"}});
  const Resting resting(client, [&session] { session.rest(); });
  co_await serve_connection(stream, client, session, metrics);
}

template <typename Stream>
Task<> play(Stream& stream, Client& client, const LineService& service, Metrics& metrics) {
  LineSession session(service, &client.loop.meter, client.memory());
  log(client.name + ": came", {{"client", client.name}, {"event", "came"}});
  const Resting resting(client, [&session] { session.rest(); });
  co_await serve_connection(stream, client, session, metrics);
  log(client.name + ": " + session.summary(), {{"client", client.name}, {"event", "left"}});
}

template <typename Stream>
Task<> play(Stream& stream, Client& client, const Service& service, Metrics& metrics) {
  return std::visit([&](const auto& kind) { return play(stream, client, kind, metrics); }, service);
}

// Answers the request of a client of the site. If the request opens a session, plays it over a WebSocket.
Task<> play_over_http(ByteStream stream, Client& client, const Service& service, Carrier& carrier,
                      Metrics& metrics) {
  if (!carrier.request) {
    boost::beast::flat_buffer buffer;
    carrier.request = (co_await exchange(stream, buffer, *carrier.site)).session;
    if (client.ending()) throw std::runtime_error("closed: " + client.reason());
    if (!carrier.request) co_return;
  }
  WebSocket socket(stream);
  co_await socket.accept(*carrier.request);
  carrier.request.reset();
  client.greeted = true;
  socket.on_control([&client] { client.is_active(); });
  ++metrics.sessions_line;
  co_await play(socket, client, std::get<LineService>(service), metrics);
  co_await socket.leave({}, client.admitted ? CloseCode::kNormal : CloseCode::kPolicyViolation);
}

template <typename Stream>
Task<> play_over(Stream& stream, Client& client, const Service& service, Carrier& carrier, Metrics& metrics) {
  if (carrier.site != nullptr) return play_over_http(ByteStream(stream), client, service, carrier, metrics);
  client.greeted = true;
  return play(stream, client, service, metrics);
}

Task<> play_over_tls(std::shared_ptr<Client> client, const Service& service, Carrier& carrier,
                     Metrics& metrics) {
  TlsStream stream(client->socket, *carrier.tls);
  error_code error;
  co_await stream.async_handshake(TlsStream::server, net::redirect_error(use_task, error));
  if (error) {
    ++metrics.refused_tls;
    throw std::runtime_error("TLS handshake failed: " + error.message());
  }
  std::exception_ptr reason;  // why the session ended, if not by itself
  try {
    co_await play_over(stream, *client, service, carrier, metrics);
  } catch (const std::exception&) {
    reason = std::current_exception();
  }
  const Patience patience(client);
  co_await stream.async_shutdown(
      net::redirect_error(use_task, error));  // tells the client that the output is complete
  if (reason) std::rethrow_exception(reason);
}

// Lists the client among those of its loop during a session.
class Presence {
 public:
  explicit Presence(Client& client) : client_(client) { client.enter_loop(); }
  ~Presence() { client_.left(); }
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;

 private:
  Client& client_;
};

}  // namespace

Task<> serve_connection(std::shared_ptr<Client> client, const Service& service, Carrier carrier,
                        Metrics& metrics) {
  try {
    const Presence presence(*client);
    if (carrier.tls) {
      co_await play_over_tls(client, service, carrier, metrics);
    } else {
      co_await play_over(client->socket, *client, service, carrier, metrics);
    }
  } catch (const std::exception& error) {
    log(client->name + ": " + error.what(), {{"client", client->name}, {"event", "left"}});
  }
  client->open.reset();
  client->admitted_open.reset();
  co_await close_gently(client);
}

Task<> turn_away(std::shared_ptr<Client> client, std::string text, bool gently) {
  error_code ignored;
  if (!text.empty()) client->socket.write_some(net::buffer(text), ignored);
  if (gently) co_await close_gently(client);
}

}  // namespace racebeam
