#include "server/connections/connection.hpp"

#include <stdexcept>
#include <string_view>
#include <utility>

#include <boost/asio/ssl.hpp>

#include "server/connections/admission.hpp"
#include "server/connections/disconnect_detector.hpp"
#include "server/connections/lingering_close.hpp"
#include "server/connections/session_loop.hpp"
#include "server/connections/session_scopes.hpp"
#include "server/connections/transport.hpp"
#include "server/operation/log.hpp"
#include "server/scheduling/keep_running.hpp"
#include "server/web/exchange.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using namespace std::chrono_literals;

// Waits for the session's turn on its loop.
Task<> wait_for_turn(Client& client) {
  client.working = true;
  co_await client.loop.turns.wait(client.loop.context, client.usage);
  client.working = false;
}

// Works until the session has a reply or needs input.
Task<> work(Client& client, PacedClassic& session) {
  Turns& turns = client.loop.turns;
  DisconnectDetector detector;
  for (bool done = false; !done;) {
    if (!turns.may_work(client.usage)) co_await wait_for_turn(client);
    if (client.ending()) throw std::runtime_error("closed: " + client.reason());
    done = session.work(turns.slice());
    turns.worked(client.usage, session.worked());
    if (!done && detector.has_gone(client.socket))
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
  limit_line(stream, session.longest_line());
  const std::size_t count = co_await receive(stream, client, session.space());
  if (count > 0 || !client.ending()) session.received(count);
}

// Between two slices of a long request, or of many requests that were sent ahead, other sessions of the loop
// get their turn. Requests that were sent ahead are split further: each part ends when its replies are sent.
template <typename Stream>
Task<> serve_connection(Stream& stream, Client& client, LineSession& session, Metrics& metrics) {
  using Next = SessionLoop::Next;
  DisconnectDetector detector;
  Turns& turns = client.loop.turns;
  SessionLoop loop(session);
  const auto run = [&] {
    const bool more = session.run(turns.slice());
    turns.worked(client.usage, session.worked());
    return more;
  };
  bool piece = false;
  for (;;) {
    if (!turns.may_work(client.usage)) co_await wait_for_turn(client);
    if (client.ending()) co_await send_farewell(stream, client);
    Next next = loop.work(run);
    if (session.admitted()) count_admission(client, metrics);
    if (client.token_attempts) co_await delay_requests(client, update_admission(client, session, metrics));
    const bool sends = next == Next::kSend;
    if (sends) {
      const std::string_view rest = send_at_once(stream, client, loop.output());
      if (!rest.empty()) co_await send_rest(stream, client, rest);
      next = loop.sent();
      piece = false;
    }
    if (next == Next::kDone) break;
    if (next == Next::kRead) {
      if (!client.ending()) co_await read(stream, client, session, std::exchange(piece, true));
    } else if (!sends && detector.has_gone(client.socket)) {
      throw std::runtime_error("the client left in the middle of a request");
    } else if (next == Next::kPause) {
      co_await await_recording(client);
    }
  }
}

template <typename Stream>
Task<> play(Stream& stream, Client& client, const ClassicService& service, Metrics& metrics) {
  count_admission(client, metrics);
  ClassicSessionScope scope(service, client.memory());
  PacedClassic& session = scope.session();
  co_await work(client, session);
  session.check_machine();
  log(client.name + ": " + describe(session.machine()), {{"client", client.name}, {"event", "came"}});
  const CacheRelease release(client, [&session] { session.release_caches(); });
  co_await serve_connection(stream, client, session, metrics);
}

template <typename Stream>
Task<> play(Stream& stream, Client& client, const LineService& service, Metrics& metrics) {
  LineSession session(service, &client.loop.meter, client.memory());
  log(client.name + ": came", {{"client", client.name}, {"event", "came"}});
  const CacheRelease release(client, [&session] { session.release_caches(); });
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
  socket.on_control([&client] { client.mark_active(); });
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
  const CloseTimer timer(client);
  // Tells the client that the output is complete.
  co_await stream.async_shutdown(net::redirect_error(use_task, error));
  if (reason) std::rethrow_exception(reason);
}

}  // namespace

Task<> serve_connection(std::shared_ptr<Client> client, const Service& service, Carrier carrier,
                        Metrics& metrics) {
  try {
    const LoopMembership membership(*client);
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
  co_await lingering_close(client);
}

}  // namespace racebeam
