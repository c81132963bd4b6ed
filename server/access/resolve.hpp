// Finds the IP address of a host.
#pragma once

#include <utility>  // needed by Asio 1.74

#include <boost/asio/ip/tcp.hpp>

#include "server/access/address.hpp"

namespace racebeam {

// The first address that the system gives for the host. May block while the system asks a name server. Throws
// AddressError if the host is unknown.
boost::asio::ip::tcp::endpoint resolve(const TcpAddress& address);

}  // namespace racebeam
