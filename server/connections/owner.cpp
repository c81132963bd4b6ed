#include "server/connections/owner.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cstring>

#include <boost/asio/ip/tcp.hpp>

#include "server/access/wrong_tokens.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;

#if defined(SO_PEERCRED)
std::string user_of(int descriptor) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return {};
  return "user " + std::to_string(peer.uid);
}
#else
std::string user_of(int) { return "a user"; }
#endif

}  // namespace

std::string owner_of(const net::generic::stream_protocol::socket& socket) {
  boost::system::error_code ignored;
  const auto peer = socket.remote_endpoint(ignored);
  if (ignored) return {};
  const int family = peer.protocol().family();
  if (family != AF_INET && family != AF_INET6)
    return user_of(const_cast<net::generic::stream_protocol::socket&>(socket).native_handle());
  net::ip::tcp::endpoint address;
  std::memcpy(address.data(), peer.data(), std::min(peer.size(), address.capacity()));
  return WrongTokens::source_of(address.address());
}

}  // namespace racebeam
