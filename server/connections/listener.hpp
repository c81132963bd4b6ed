// One address where clients come in.
#pragma once

#include <string>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio.hpp>

#include "server/access/activation.hpp"
#include "server/access/address.hpp"
#include "server/connections/client.hpp"
#include "server/operation/unlink_on_exit.hpp"

namespace racebeam {

using Acceptor = boost::asio::basic_socket_acceptor<Protocol>;

class Listener {
 public:
  // Listens from now on, on a TCP or Unix address. Throws std::runtime_error for one that can't be had. The
  // socket file of a server that died is replaced; that of a live one is not.
  Listener(const boost::asio::any_io_executor& executor, const Endpoint& endpoint);

  // A socket that listens already; its file, if it has one, is not ours to remove.
  Listener(const boost::asio::any_io_executor& executor, const Endpoint& endpoint,
           const InheritedSocket& inherited);

  ~Listener();  // removes its socket file
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  Acceptor& acceptor() { return acceptor_; }
  const std::string& name() const { return name_; }  // the address, with the port that was picked
  std::string full_name() const { return (endpoint_.classic ? "classic+" : "") + name_; }
  const Endpoint& endpoint() const { return endpoint_; }
  bool is_local() const { return local_; }  // a Unix socket: the file system says who may come
  bool is_loopback() const;                 // only this machine can reach it

  void close();  // whoever comes from now on is refused by the system

 private:
  void listen(const TcpAddress& address);
  void listen(const UnixAddress& address);
  void bind(const Protocol::endpoint& endpoint);
  void describe();

  Endpoint endpoint_;
  Acceptor acceptor_;
  std::string name_, host_;
  bool local_ = true;
  UnlinkOnExit file_;  // of a Unix socket
};

}  // namespace racebeam
