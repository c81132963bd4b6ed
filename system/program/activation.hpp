// Sockets that systemd, or another manager with its convention, opened for this process (sd_listen_fds(3)).
#pragma once

#include <string>
#include <vector>

namespace racebeam {

struct InheritedSocket {
  int descriptor;
  std::string name;  // from LISTEN_FDNAMES; "unknown" without it, as in systemd
};

// The sockets of LISTEN_FDS; empty unless LISTEN_PID is this process. Throws std::runtime_error if the
// variables are invalid.
std::vector<InheritedSocket> inherited_sockets();

// Sends a state such as "READY=1" or "STOPPING=1" to the manager of the service, if it has asked for that
// (sd_notify(3)). Ignores errors.
void notify_manager(const std::string& state);

}  // namespace racebeam
