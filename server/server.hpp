// A server: sessions for all who come to its endpoints, until it is told to stop.
#pragma once

#include "server/connections/service.hpp"
#include "server/connections/settings.hpp"

namespace racebeam {

// Returns the exit status of the process, once SIGTERM or SIGINT came (0), or every endpoint has ended: those
// of one session, standard streams and pipes, end with it (their status), sockets never do. Every session has
// a machine of its own and shares nothing with the others: one that is slow, or makes no sense, only harms
// itself. SIGHUP reads tokens and certificate again; a second SIGTERM or SIGINT ends the grace period.
//
// Throws std::runtime_error or std::invalid_argument when the start fails; nothing is left behind then.
int serve(const ServerSettings& settings, const Services& services);

}  // namespace racebeam
