#include "server/sockets.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <list>
#include <memory>
#include <thread>

#include "server/listener.hpp"
#include "server/log.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::use_awaitable;
using namespace std::chrono_literals;

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

// Closing with input unread would make the system throw away what the client has not read yet.
net::awaitable<void> close_gently(std::shared_ptr<Socket> socket) {
  error_code error;
  socket->shutdown(Socket::shutdown_send, error);
  net::steady_timer patience(socket->get_executor(), 2s);
  patience.async_wait([socket](error_code cancelled) {
    error_code ignored;
    if (!cancelled) socket->close(ignored);
  });
  std::array<char, 4096> rest;
  while (!error) {
    co_await socket->async_read_some(net::buffer(rest), net::redirect_error(use_awaitable, error));
  }
}

net::awaitable<void> play(std::shared_ptr<Socket> socket, const ClassicService& service, std::string name) {
  try {
    Environment machine = service.power_on();
    log(name + ": " + describe(machine));
    ClassicSession session(machine, service.options);
    co_await converse(*socket, session);
  } catch (const std::exception& error) {
    log(name + ": " + error.what());
  }
  co_await close_gently(socket);
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

// Each session runs on its own strand of the pool.
net::awaitable<void> welcome(Listener& listener, net::thread_pool& pool, const ClassicService& service) {
  for (int number = 1;; ++number) {
    error_code error;
    const net::any_io_executor strand = net::make_strand(pool.get_executor());
    Socket socket =
        co_await listener.acceptor().async_accept(strand, net::redirect_error(use_awaitable, error));
    if (error) {  // out of descriptors, most likely; it may pass
      log("cannot take a client on " + listener.name() + ": " + error.message());
      co_await pause();
      continue;
    }
    set_options(socket);
    const std::string name = listener.name() + " client " + std::to_string(number);
    net::co_spawn(strand, play(std::make_shared<Socket>(std::move(socket)), service, name), net::detached);
  }
}

}  // namespace

int serve_sockets(const std::vector<std::string>& addresses, const ClassicService& service) {
  std::signal(SIGPIPE, SIG_IGN);
  service.power_on();  // an image or a setting that does not work should show now
  net::thread_pool pool(std::max(1U, std::thread::hardware_concurrency()));
  net::signal_set signals(pool, SIGTERM, SIGINT);
  std::list<Listener> listeners;
  for (const std::string& address : addresses)
    listeners.emplace_back(pool.get_executor(), parse_address(address));
  for (Listener& listener : listeners) {
    net::co_spawn(pool, welcome(listener, pool, service), net::detached);
    log("listening on " + listener.name());
  }
  signals.async_wait([&pool](error_code, int) { pool.stop(); });
  pool.join();
  return 0;
}

}  // namespace racebeam
