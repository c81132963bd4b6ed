// Sockets that systemd, or who follows its convention, has opened for this process (sd_listen_fds(3)).
#pragma once

#include <string>
#include <vector>

namespace racebeam {

struct InheritedSocket {
  int descriptor;
  std::string name;  // of LISTEN_FDNAMES; "unknown" without, as in systemd
};

// Those of LISTEN_FDS, if LISTEN_PID says that they are for this process; none otherwise. Throws
// std::runtime_error when the variables make no sense.
std::vector<InheritedSocket> inherited_sockets();

// To who started the server, if it wants to know (sd_notify(3)): "READY=1", "STOPPING=1". Never fails.
void notify_manager(const std::string& state);

}  // namespace racebeam
