#include "server/connections/owner.hpp"

#include <algorithm>
#include <cstring>

#include <boost/asio/ip/tcp.hpp>

#include "server/access/wrong_tokens.hpp"
#include "system/program/sockets.hpp"

namespace racebeam {

namespace net = boost::asio;

std::string owner_of(const net::generic::stream_protocol::socket& socket) {
  boost::system::error_code ignored;
  const auto peer = socket.remote_endpoint(ignored);
  if (ignored) return {};
  const int family = peer.protocol().family();
  if (family != AF_INET && family != AF_INET6)
    return user_of_peer(static_cast<SocketNumber>(
        const_cast<net::generic::stream_protocol::socket&>(socket).native_handle()));
  net::ip::tcp::endpoint address;
  std::memcpy(address.data(), peer.data(), std::min(peer.size(), address.capacity()));
  return WrongTokens::source_of(address.address());
}

}  // namespace racebeam
