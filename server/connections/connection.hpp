// Serves one connection on its event loop: bytes to and from the session, over a plain socket, TLS or
// WebSocket.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/ssl/context.hpp>

#include "server/connections/client.hpp"
#include "server/connections/service.hpp"
#include "server/web/site.hpp"

namespace racebeam {

// The layers below the protocol of a session.
struct Carrier {
  std::shared_ptr<boost::asio::ssl::context> tls;  // null: no TLS
  const Site* site = nullptr;                      // null: no HTTP
  std::optional<HttpRequest> request;              // over HTTP: opens the session, if already received
};

// Serves the whole session on the client's loop. `service` and the site must outlive it. Throws nothing but
// std::bad_alloc.
Task<> serve_connection(std::shared_ptr<Client> client, const Service& service, Carrier carrier,
                        Metrics& metrics);

}  // namespace racebeam
