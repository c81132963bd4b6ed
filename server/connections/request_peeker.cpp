#include "server/connections/request_peeker.hpp"

#include <algorithm>
#include <array>

namespace racebeam {

namespace net = boost::asio;
using boost::system::error_code;

RequestPeeker::RequestPeeker(Socket* socket) : socket_(socket) {
  error_code ignored;
  wakes_ = socket != nullptr && socket->local_endpoint(ignored).protocol().family() == AF_UNIX;
}

Socket::message_flags RequestPeeker::flags(bool client_sleeps) const {
  return wakes_ && client_sleeps ? Socket::message_peek : 0;
}

std::size_t RequestPeeker::look(std::span<char> space) {
  if (socket_ == nullptr || space.empty()) return 0;
  error_code nothing;
  if (seen_ > 0 && socket_->available(nothing) == seen_) return 0;  // nothing new was received
  take();
  seen_ = socket_->receive(net::buffer(space.data(), space.size()), Socket::message_peek, nothing);
  return seen_;
}

// If the socket fails here, it fails for the next reader, too.
void RequestPeeker::take() {
  std::array<char, 4096> unused;
  while (seen_ > 0) {
    error_code error;
    seen_ -= socket_->receive(net::buffer(unused.data(), std::min(seen_, unused.size())), 0, error);
    if (error) seen_ = 0;
  }
}

}  // namespace racebeam
