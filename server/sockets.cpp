#include "server/sockets.hpp"

#include <poll.h>

#include <array>
#include <chrono>
#include <csignal>
#include <list>
#include <memory>
#include <thread>

#include "server/listener.hpp"
#include "server/log.hpp"
#include "server/loops.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::use_awaitable;
using namespace std::chrono_literals;

// Somebody who came in; counts as a session of the loop until the end.
struct Client {
  Client(Socket connection, Loop& home, std::string who)
      : socket(std::move(connection)), loop(home), name(std::move(who)) {
    ++loop.sessions;
  }
  ~Client() { --loop.sessions; }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  Socket socket;
  Loop& loop;
  std::string name;
};

net::awaitable<void> converse(Socket& socket, ClassicSession& session) {
  error_code error;
  while (!session.ended()) {
    if (const auto text = session.reply()) {
      co_await net::async_write(socket, net::buffer(*text), net::redirect_error(use_awaitable, error));
      if (error && !session.ended()) throw std::runtime_error("the client stopped reading");
    } else {
      const auto space = net::buffer(session.space().data(), session.space().size());
      session.received(co_await socket.async_read_some(space, net::redirect_error(use_awaitable, error)));
    }
  }
}

// Waiting for it may take for ever: a client that only closed its sending end still listens.
bool has_gone(Socket& socket) {
  pollfd state{socket.native_handle(), 0, 0};
  return ::poll(&state, 1, 0) > 0 && (state.revents & (POLLHUP | POLLERR)) != 0;
}

// Between two slices of a long request, the loop's other sessions have their turn.
net::awaitable<void> converse(Socket& socket, LineSession& session) {
  error_code error;
  for (;;) {
    const bool more = session.run();
    if (const auto text = session.output(); !text.empty()) {
      co_await net::async_write(socket, net::buffer(text), net::redirect_error(use_awaitable, error));
      if (error) throw std::runtime_error("the client stopped reading");
      session.sent(text.size());
    }
    if (session.finished()) break;
    if (more) {
      if (has_gone(socket)) throw std::runtime_error("the client left in the middle of a request");
      co_await net::post(socket.get_executor(), use_awaitable);
    } else {
      const auto space = net::buffer(session.space().data(), session.space().size());
      session.received(co_await socket.async_read_some(space, net::redirect_error(use_awaitable, error)));
    }
  }
}

// Closing with input unread would make the system throw away what the client has not read yet.
net::awaitable<void> close_gently(std::shared_ptr<Client> client) {
  error_code error;
  client->socket.shutdown(Socket::shutdown_send, error);
  net::steady_timer patience(client->socket.get_executor(), 2s);
  patience.async_wait([client](error_code cancelled) {
    error_code ignored;
    if (!cancelled) client->socket.close(ignored);
  });
  std::array<char, 4096> rest;
  while (!error) {
    co_await client->socket.async_read_some(net::buffer(rest), net::redirect_error(use_awaitable, error));
  }
}

net::awaitable<void> play(Client& client, const ClassicService& service) {
  Environment machine = service.power_on();
  log(client.name + ": " + describe(machine));
  ClassicSession session(machine, service.options);
  co_await converse(client.socket, session);
}

net::awaitable<void> play(Client& client, const LineService& service) {
  LineSession session(service);
  log(client.name + ": came");
  co_await converse(client.socket, session);
  log(client.name + ": " + session.summary());
}

net::awaitable<void> play(std::shared_ptr<Client> client, const Service& service) {
  try {
    co_await std::visit([&client](const auto& kind) { return play(*client, kind); }, service);
  } catch (const std::exception& error) {
    log(client->name + ": " + error.what());
  }
  co_await close_gently(client);
}

void set_options(Socket& socket) {
  error_code ignored;  // a Unix socket knows no delay
  socket.set_option(net::ip::tcp::no_delay(true), ignored);
  socket.set_option(net::socket_base::keep_alive(true), ignored);
}

net::awaitable<void> pause() {
  net::steady_timer timer(co_await net::this_coro::executor, 100ms);
  co_await timer.async_wait(use_awaitable);
}

net::awaitable<void> welcome(Listener& listener, Loops& loops, const Service& service) {
  for (int number = 1;; ++number) {
    Loop& loop = loops.idlest();
    error_code error;
    Socket socket =
        co_await listener.acceptor().async_accept(loop.context, net::redirect_error(use_awaitable, error));
    if (error) {  // out of descriptors, most likely; it may pass
      log("cannot take a client on " + listener.name() + ": " + error.message());
      co_await pause();
      continue;
    }
    set_options(socket);
    std::string name = listener.name() + " client " + std::to_string(number);
    auto client = std::make_shared<Client>(std::move(socket), loop, std::move(name));
    net::co_spawn(loop.context, play(std::move(client), service), net::detached);
  }
}

}  // namespace

int serve_sockets(const std::vector<std::string>& addresses, const Service& service) {
  std::signal(SIGPIPE, SIG_IGN);
  Loops loops(std::thread::hardware_concurrency());
  net::io_context& first = loops.first().context;
  net::signal_set signals(first, SIGTERM, SIGINT);
  std::list<Listener> listeners;
  for (const std::string& address : addresses) {
    listeners.emplace_back(first.get_executor(), parse_address(address));
  }
  for (Listener& listener : listeners) {
    net::co_spawn(first, welcome(listener, loops, service), net::detached);
    log("listening on " + listener.name());
  }
  signals.async_wait([&loops](error_code, int) { loops.stop(); });
  loops.run();
  return 0;
}

}  // namespace racebeam
