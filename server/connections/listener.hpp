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
  // Listens from now on, on a TCP or Unix address. Throws std::runtime_error if that cannot be used. The
  // socket file of a server that died is replaced; that of a live server is not.
  Listener(const boost::asio::any_io_executor& executor, const Endpoint& endpoint);

  // A socket that listens already. Its file, if it has one, is not removed.
  Listener(const boost::asio::any_io_executor& executor, const Endpoint& endpoint,
           const InheritedSocket& inherited);

  ~Listener();  // removes its socket file
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  Acceptor& acceptor() { return acceptor_; }
  const std::string& name() const { return name_; }  // the address, with the port that was picked
  std::string full_name() const { return (endpoint_.classic ? "classic+" : "") + name_; }
  std::string described() const;  // for the log: the name, with the IP address that a host name stands for
  std::string announced(const std::string& host) const;  // for clients: `host` instead of all addresses
  const Endpoint& endpoint() const { return endpoint_; }
  bool is_local() const { return local_; }  // a Unix socket, protected by the file system
  bool is_loopback() const;                 // only this machine can reach it

  int count_client() { return ++clients_; }  // returns how many have come

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
  UnlinkOnExit file_;  // of a Unix socket
};

}  // namespace racebeam
