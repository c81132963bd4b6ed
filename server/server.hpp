// Runs a server: serves sessions on its endpoints until it is asked to stop.
#pragma once

#include "server/connections/service.hpp"
#include "server/connections/settings.hpp"

namespace racebeam {

// Returns the exit status of the process after SIGTERM or SIGINT (0), or when every endpoint has ended. An
// endpoint with a single session (standard streams or pipes) ends with that session, and has its status.
// Sockets end only after until_idle_seconds without a session. Every session has its own machine, and does
// not share anything with others that a slow or faulty client could affect. At SIGHUP, the server reads
// tokens and certificate again. A second SIGTERM or SIGINT ends the grace period.
//
// Throws std::runtime_error or std::invalid_argument if the start fails, and undoes it.
int serve(const ServerSettings& settings, const Services& services);

}  // namespace racebeam
