// One address at which the server accepts connections.
#pragma once

#include <string>
#include <utility>  // needed by Asio 1.74

#include <boost/asio.hpp>

#include "server/access/address.hpp"
#include "server/connections/client.hpp"
#include "server/operation/unlink_on_exit.hpp"
#include "system/program/activation.hpp"

namespace racebeam {

using Acceptor = boost::asio::basic_socket_acceptor<Protocol>;

class Listener {
 public:
  // Listens from now on, on a TCP or Unix address. Throws std::runtime_error if the address cannot be used.
  // Replaces the socket file of a server that died, but not that of a live server.
  Listener(const boost::asio::any_io_executor& executor, const Endpoint& endpoint);

  // Takes a socket that listens already. Does not remove its file, if it has one.
  Listener(const boost::asio::any_io_executor& executor, const Endpoint& endpoint,
           const InheritedSocket& inherited);

  ~Listener();  // removes its socket file
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  Acceptor& acceptor() { return acceptor_; }
  const std::string& name() const { return name_; }  // the address, with the port that was picked
  std::string full_name() const { return (endpoint_.classic ? "classic+" : "") + name_; }
  std::string described() const;  // for the log: the name, and the IP address of a host name
  std::string announced(const std::string& host) const;  // for clients: `host` stands for all addresses
  const Endpoint& endpoint() const { return endpoint_; }
  bool is_local() const { return local_; }  // a Unix socket, protected by the file system
  bool is_loopback() const;                 // only this machine can reach it

  int count_client() { return ++clients_; }  // returns how many clients have come

  void close();  // from now on, the system refuses connections

 private:
  void listen(const TcpAddress& address);
  void listen(const UnixAddress& address);
  void bind(const Protocol::endpoint& endpoint);
  void describe();

  Endpoint endpoint_;
  Endpoint bound_;  // the actual address, without classic+
  Acceptor acceptor_;
  std::string name_, host_;
  int clients_ = 0;
  bool local_ = true;
  UnlinkOnExit file_;  // the file of a Unix socket
};

}  // namespace racebeam
