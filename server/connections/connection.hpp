// Serves one connection on its event loop: bytes to and from the session, over a plain socket or TLS.
#pragma once

#include <memory>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ssl/context.hpp>

#include "server/connections/client.hpp"
#include "server/connections/service.hpp"

namespace racebeam {

// Serves the whole session on the client's loop. `service` must outlive it; `tls` is null for a plain socket.
// Never throws.
boost::asio::awaitable<void> serve_connection(std::shared_ptr<Client> client, const Service& service,
                                              std::shared_ptr<boost::asio::ssl::context> tls,
                                              Metrics& metrics);

// Closes the connection. If `understands`, sends the reason before, as a line of the line protocol.
boost::asio::awaitable<void> turn_away(std::shared_ptr<Client> client, bool understands);

}  // namespace racebeam
