// Health and metrics over HTTP. /healthz: 200 while the process lives. /readyz: 200, or 503 after the server
// was told to stop. /metrics: for Prometheus.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <utility>  // needed by Asio 1.74

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
  // Listens from now on, and serves while the loop runs. Throws std::runtime_error if the address cannot be
  // used.
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
  // Ordered by the latest request, or else the connection; the oldest is first.
  std::list<Connection> connections_;
};

}  // namespace racebeam
