// Any number of sessions over TCP and Unix sockets, on a pool of threads.
#pragma once

#include <string>
#include <vector>

#include "server/service.hpp"

namespace racebeam {

// Serves all who come until SIGTERM or SIGINT; returns the exit status of the process. Every session has a
// machine of its own and shares nothing with the others: one that is slow, or makes no sense, only harms
// itself.
int serve_sockets(const std::vector<std::string>& addresses, const Service& service);

}  // namespace racebeam
