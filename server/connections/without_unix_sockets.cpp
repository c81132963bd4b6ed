// For systems without Unix sockets, where parse_endpoint() refuses their addresses.
#include "server/access/address.hpp"
#include "server/connections/unix_socket.hpp"

namespace racebeam {

void bind_unix_socket(const std::string&, const std::string& name,
                      const std::function<void(const Protocol::endpoint&)>&) {
  throw AddressError("cannot listen on " + name + ": this system has no Unix sockets");
}

std::optional<std::string> unix_path_of(const Protocol::endpoint&) { return std::nullopt; }

}  // namespace racebeam
