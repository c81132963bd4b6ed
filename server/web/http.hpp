// The site of a server on a port of its own (--http).
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
#include "server/web/site.hpp"

namespace racebeam {

class Http {
 public:
  // Takes over a connection whose request opens a session. Its descriptor is the callee's.
  using OnSession = std::function<void(int descriptor, HttpRequest request)>;

  // Listens from now on. Throws std::runtime_error if the address cannot be used.
  Http(boost::asio::io_context& loop, const TcpAddress& address);

  // Serves while the loop runs.
  void open(Site site, OnSession on_session);

  const std::string& name() const { return name_; }  // http://HOST:PORT
  bool is_loopback() const;                          // only this machine can reach it

 private:
  using Connection = std::shared_ptr<boost::beast::tcp_stream>;

  boost::asio::awaitable<void> welcome();
  void make_room();  // for one more connection
  boost::asio::awaitable<void> serve(Connection connection);

  boost::asio::ip::tcp::acceptor acceptor_;
  Site site_;
  OnSession on_session_;
  std::string name_;
  // Ordered by the latest request, or else the connection; the oldest is first.
  std::list<Connection> connections_;
};

}  // namespace racebeam
