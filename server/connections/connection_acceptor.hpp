// Lets clients in: who may, where, and how many.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>  // Asio 1.74 forgets it
#include <vector>

#include <boost/asio/awaitable.hpp>

#include "server/connections/lobby.hpp"
#include "server/access/tls.hpp"
#include "server/access/tokens.hpp"
#include "server/access/wrong_tokens.hpp"
#include "server/connections/listener.hpp"
#include "server/connections/service.hpp"
#include "server/connections/settings.hpp"

namespace racebeam {

class ConnectionAcceptor {
 public:
  // Listens on every socket of the settings; all outlive it. Throws std::runtime_error for what can't be had
  // or is not safe.
  ConnectionAcceptor(const ServerSettings& settings, const Services& services, Loops& loops,
                     Metrics& metrics);

  std::vector<std::string> names() const;  // of the listeners
  bool empty() const { return listeners_.empty(); }
  void open();        // clients are welcome from now on
  void close();       // no more come in
  void read_again();  // tokens and certificate; what is wrong is logged, and the old ones stay

 private:
  void listen(const Endpoint& endpoint);
  void listen_inherited(const Endpoint& endpoint, const std::string& name);
  void check(const Listener& listener) const;  // that it is safe
  const Service& service_of(const Listener& listener) const;
  boost::asio::awaitable<void> welcome(Listener& listener);
  std::optional<std::string> obstacle(const Service& service);  // to one more session
  void admit(Socket socket, Loop& loop, const Listener& listener, int number);

  const ServerSettings& settings_;
  const Services& services_;
  Loops& loops_;
  Metrics& metrics_;
  std::optional<Tokens> tokens_;
  WrongTokens wrong_tokens_;
  const std::shared_ptr<Lobby> lobby_ = std::make_shared<Lobby>();
  std::optional<Tls> tls_;
  std::optional<Service> guarded_;  // the line protocol, for those who have a token
  std::list<Listener> listeners_;
  std::set<int> taken_;  // of the descriptors that we inherited
  bool closed_ = false;
};

}  // namespace racebeam
