// Health and metrics for those who run a server, over HTTP:
// /healthz 200 while the process lives; /readyz 200, or 503 once it is told to stop; /metrics for Prometheus.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/tcp_stream.hpp>

#include "server/access/address.hpp"

namespace racebeam {

struct HttpPages {
  std::function<bool()> ready;
  std::function<std::string()> metrics;
};

class Http {
 public:
  // Listens from now on, and serves when the loop runs. Throws std::runtime_error for an address that can't
  // be had.
  Http(boost::asio::io_context& loop, const TcpAddress& address, HttpPages pages);

  const std::string& name() const { return name_; }  // http://HOST:PORT

 private:
  using Connection = std::shared_ptr<boost::beast::tcp_stream>;

  boost::asio::awaitable<void> welcome();
  void make_room();  // for one more connection
  boost::asio::awaitable<void> serve(Connection connection);

  boost::asio::ip::tcp::acceptor acceptor_;
  HttpPages pages_;
  std::string name_;
  std::list<Connection> connections_;  // the one whose latest request, or coming, is longest ago is the first
};

}  // namespace racebeam
