// Sockets, by the numbers that the system has for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace racebeam {

using SocketNumber = std::intptr_t;

// Whether the system has Unix sockets, named pipes, and sockets that another process passes on. On Windows, a
// server has only TCP and standard streams.
bool has_local_channels();
std::size_t longest_socket_path();  // of a Unix socket, in bytes; 0 if the system does not have them

// Called before a socket is bound. The address is then free as soon as no other socket listens there.
void claim_address(SocketNumber socket);

void close_socket(SocketNumber socket);
void acknowledge_at_once(SocketNumber socket);  // acknowledges what TCP has received last; not on Windows

// The state of the other end, found without waiting. kHalfClosed: it has closed its sending end, and may
// still read.
enum class PeerState { kThere, kHalfClosed, kGone };
PeerState state_of_peer(SocketNumber socket);

// Whether no process has the other end of a TCP connection any more. False if the other end is on another
// machine, or the system does not report it (sock_diag(7)).
bool peer_has_closed(SocketNumber socket);

// From now on, TCP asks every five seconds whether the other end is still there.
void probe_often(SocketNumber socket);

// The user at the other end of a Unix socket, such as "user 1000"; empty if the user is unknown.
std::string user_of_peer(SocketNumber socket);

}  // namespace racebeam
