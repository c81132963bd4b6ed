// Sockets, by the numbers that the system has for them.
#pragma once

#include <cstdint>
#include <string>

namespace racebeam {

using SocketNumber = std::intptr_t;

// Unix sockets, named pipes, and sockets that another process passes on. Windows serves TCP and standard
// streams only.
bool has_local_channels();

// Before a socket is bound: an address is free as soon as no other socket listens there.
void claim_address(SocketNumber socket);

void close_socket(SocketNumber socket);
void acknowledge_at_once(SocketNumber socket);  // what TCP has received last; not on Windows

// The other end, without waiting. One that has only closed its sending end may still read.
enum class PeerState { kThere, kHalfClosed, kGone };
PeerState state_of_peer(SocketNumber socket);

// Whether no process has the other end of a TCP connection any more. False if the other end is elsewhere, or
// the system does not tell (sock_diag(7)).
bool peer_has_closed(SocketNumber socket);

// From now on, TCP asks every five seconds whether the other end is still there.
void probe_often(SocketNumber socket);

// "user 1000", for a Unix socket; empty if the other end is unknown.
std::string user_of_peer(SocketNumber socket);

}  // namespace racebeam
