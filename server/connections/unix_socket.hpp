// Sockets that have a name in the file system (Unix sockets).
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "server/connections/client.hpp"

namespace racebeam {

// Calls bind() with the endpoint of a path. `name` is the address in messages. The file of a server that died
// is removed before. Throws AddressError.
void bind_unix_socket(const std::string& path, const std::string& name,
                      const std::function<void(const Protocol::endpoint&)>& bind);

// Nothing for a socket of another kind.
std::optional<std::string> unix_path_of(const Protocol::endpoint& endpoint);

}  // namespace racebeam
