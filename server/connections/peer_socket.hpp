// The other end of a TCP connection, if it is a socket of this machine.
#pragma once

namespace racebeam {

// Whether no process has the other end any more. False if the other end is elsewhere, or the system does not
// tell (sock_diag(7)).
bool peer_has_closed(int descriptor);

}  // namespace racebeam
