// Accepts connections, within the limits of the server.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>  // needed by Asio 1.74
#include <vector>

#include <boost/asio/awaitable.hpp>

#include "server/access/tls.hpp"
#include "server/access/tokens.hpp"
#include "server/access/wrong_tokens.hpp"
#include "server/connections/connection.hpp"
#include "server/connections/listener.hpp"
#include "server/connections/lobby.hpp"
#include "server/connections/service.hpp"
#include "server/connections/settings.hpp"

namespace racebeam {

class ConnectionAcceptor {
 public:
  // Listens on every socket of the settings. own_token: admitted besides those of the token file; empty:
  // none. All other parameters must outlive it. Throws std::runtime_error for addresses that cannot be used,
  // or are not safe.
  ConnectionAcceptor(const ServerSettings& settings, const Services& services, Loops& loops, Metrics& metrics,
                     const std::string& own_token);

  std::vector<std::string> names() const;  // of the listeners
  // The addresses for clients of the line protocol; `host` stands for all addresses of this machine.
  std::vector<std::string> announced(const std::string& host) const;
  bool empty() const { return listeners_.empty(); }
  void open();        // accepts clients from now on
  void close();       // accepts no more
  void read_again();  // tokens and certificate; errors are logged, and the old ones stay in use

  // Which pages may open a session over HTTP. Nothing: none may, because other machines can reach the server,
  // and it requires no token, or because it does not speak the line protocol.
  std::optional<OriginRules> session_rules(bool is_loopback) const;
  // Admits a client of --http, whose `request` opens a session. Closes `descriptor` at the end.
  void admit_over_http(int descriptor, HttpRequest request, const std::string& address);

 private:
  void listen(const Endpoint& endpoint);
  void listen_inherited(const Endpoint& endpoint, const std::string& name);
  void check(const Listener& listener) const;  // throws unless it is safe
  const Service& service_of(const Listener& listener) const;
  const Service& guarded_service() const { return guarded_ ? *guarded_ : *services_.line; }
  boost::asio::awaitable<void> welcome(Listener& listener);
  // The reason against one more session; nothing if there is none.
  std::optional<std::string> obstacle(const Service& service);
  void admit(std::shared_ptr<Client> client, const Service& service, Carrier carrier,
             const Endpoint& endpoint);
  void admit(Socket socket, Loop& loop, const Listener& listener, int number);

  const ServerSettings& settings_;
  const Services& services_;
  Loops& loops_;
  Metrics& metrics_;
  std::optional<Tokens> tokens_;
  WrongTokens wrong_tokens_;
  const std::shared_ptr<Lobby> lobby_ = std::make_shared<Lobby>();
  std::optional<Tls> tls_;
  std::optional<Service> guarded_;  // the line protocol, with tokens required
  std::list<Listener> listeners_;
  Site site_;            // of ws:// and wss:// addresses
  int from_http_ = 0;    // number of clients of --http
  std::set<int> taken_;  // inherited descriptors that are in use
  bool closed_ = false;
};

}  // namespace racebeam
