// A client's session on its event loop: bytes to and from it, over a plain socket or TLS.
#pragma once

#include <memory>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ssl/context.hpp>

#include "server/connections/client.hpp"
#include "server/connections/service.hpp"

namespace racebeam {

// The whole session, to its end, on the client's loop. `service` outlives it; `tls` is null for a plain
// socket. Never throws.
boost::asio::awaitable<void> serve_connection(std::shared_ptr<Client> client, const Service& service,
                                              std::shared_ptr<boost::asio::ssl::context> tls,
                                              Metrics& metrics);

// Closes; before that it says why there is no session, if a plain line is what the client would understand.
boost::asio::awaitable<void> turn_away(std::shared_ptr<Client> client, bool understands);

}  // namespace racebeam
