// Accepts connections, within the limits of the server.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>  // needed by Asio 1.74
#include <vector>

#include "server/connections/access_control.hpp"
#include "server/connections/connection.hpp"
#include "server/connections/listener.hpp"
#include "server/connections/lobby.hpp"
#include "server/connections/service.hpp"
#include "server/connections/settings.hpp"

namespace racebeam {

class ConnectionAcceptor {
 public:
  // Listens on every socket of the settings. All parameters must outlive it. Throws std::runtime_error for
  // addresses that cannot be used, or are not safe.
  ConnectionAcceptor(const ServerSettings& settings, const Services& services, AccessControl& access,
                     Loops& loops, Metrics& metrics);

  std::vector<std::string> names() const;  // of the listeners
  // The addresses for clients of the line protocol. If a listener has all addresses of this machine, `host`
  // takes their place.
  std::vector<std::string> announced(const std::string& host) const;
  bool empty() const { return listeners_.empty(); }
  // Accepts clients from now on, up to this many connections, or up to the limit of the settings if that is
  // lower.
  void open(int most_connections);
  void close();  // accepts no more

  // Admits a client of --http, whose `request` opens a session. The socket belongs to the first loop.
  void admit_over_http(Socket socket, HttpRequest request, const std::string& address);

 private:
  void listen(const Endpoint& endpoint);
  void listen_inherited(const Endpoint& endpoint, const std::string& name);
  void check(const Listener& listener) const;  // throws unless it is safe
  const Service& service_of(const Listener& listener) const;
  Task<> accept_clients(Listener& listener);
  // Returns why there cannot be one more session; nothing if there can.
  std::optional<std::string> reason_to_refuse(const Service& service);
  // Admits the client at once, or after memory has been freed for it. Runs on the first loop's thread.
  void admit_when_memory_allows(std::shared_ptr<Client> client, const Service& service, Carrier carrier,
                                const Endpoint& endpoint);
  Task<> admit_after_relief(std::shared_ptr<Client> client, const Service& service, Carrier carrier,
                            Endpoint endpoint);
  void admit(std::shared_ptr<Client> client, const Service& service, Carrier carrier,
             const Endpoint& endpoint);
  void admit(Socket socket, Loop& loop, Listener& listener);

  const ServerSettings& settings_;
  const Services& services_;
  AccessControl& access_;
  Loops& loops_;
  Metrics& metrics_;
  const std::shared_ptr<Lobby> lobby_ = std::make_shared<Lobby>();
  std::list<Listener> listeners_;
  int max_connections_ = 0;
  int from_http_ = 0;    // number of clients of --http
  int waiting_ = 0;      // clients that wait for memory
  std::set<int> taken_;  // inherited descriptors that are in use
  bool closed_ = false;
};

}  // namespace racebeam
