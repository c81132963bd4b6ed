// The owner of a connection: a user of this machine, for a Unix socket, or an address.
#pragma once

#include <string>

#include <boost/asio/generic/stream_protocol.hpp>

namespace racebeam {

// The owner of a client that has disconnected already is unknown; all such clients have the same owner.
std::string owner_of(const boost::asio::generic::stream_protocol::socket& socket);

}  // namespace racebeam
