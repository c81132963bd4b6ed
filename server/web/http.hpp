// The web site of a server, on its own port (--http).
#pragma once

#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/access/address.hpp"
#include "server/scheduling/task.hpp"
#include "server/web/byte_stream.hpp"
#include "server/web/site.hpp"

namespace racebeam {

class Http {
 public:
  // Takes over a connection whose request opens a session. Its descriptor is the callee's.
  using OnSession = std::function<void(ByteStream::Socket, HttpRequest)>;

  // Listens from now on. Throws std::runtime_error if the address cannot be used.
  Http(boost::asio::io_context& loop, const TcpAddress& address);
  ~Http();
  Http(const Http&) = delete;
  Http& operator=(const Http&) = delete;

  // Serves while the loop runs.
  void open(Site site, OnSession on_session);

  const std::string& name() const { return name_; }  // http://HOST:PORT
  bool is_loopback() const;                          // only this machine can reach it

 private:
  struct OpenConnection {
    explicit OpenConnection(ByteStream::Socket accepted)
        : socket(std::move(accepted)), timeout(socket.get_executor()) {}

    ByteStream::Socket socket;
    boost::asio::steady_timer timeout;
  };
  using Connection = std::shared_ptr<OpenConnection>;

  Task<> accept_clients();
  Task<boost::asio::ip::tcp::socket> accept_without_files(boost::system::error_code& error);
  void make_room();       // for one more connection
  bool make_file_room();  // for the file of one more connection; returns false if that is impossible
  void close_oldest();
  void remove(const Connection& connection);
  static void close_after(std::chrono::seconds limit, const Connection& connection);
  Task<> serve(Connection connection);
  Task<> serve_requests(Connection connection);
  Task<> drain(Connection connection);

  boost::asio::io_context& loop_;
  boost::asio::ip::tcp::acceptor acceptor_;
  Site site_;
  OnSession on_session_;
  std::string name_;
  // Ordered by the time of the latest request, or of the connection if there was no request; the oldest is
  // first.
  std::list<Connection> connections_;
  int spare_ = -1;  // a descriptor in reserve, which is closed for a connection when there are no others
};

}  // namespace racebeam
