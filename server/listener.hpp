// One address where clients come in.
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio.hpp>

#include "server/address.hpp"

namespace racebeam {

using Protocol = boost::asio::generic::stream_protocol;
using Socket = Protocol::socket;
using Acceptor = boost::asio::basic_socket_acceptor<Protocol>;

class Listener {
 public:
  // Listens from now on. Throws std::runtime_error for an address that can't be had. The socket file of a
  // server that died is replaced; that of a live one is not.
  Listener(const boost::asio::any_io_executor& executor, const Address& address);
  ~Listener();  // removes its socket file
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  Acceptor& acceptor() { return acceptor_; }
  const std::string& name() const { return name_; }  // the address, with the port that was picked

 private:
  void listen(const TcpAddress& address);
  void listen(const UnixAddress& address);
  void bind(const Protocol::endpoint& endpoint);

  Acceptor acceptor_;
  std::string name_;
  std::string path_;  // of the socket file
  ino_t file_ = 0;    // the file itself: somebody may have put another in its place
};

}  // namespace racebeam
