// Sends and receives the bytes of a session over a plain socket, TLS or a WebSocket, and counts them for its
// client.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>  // needed by Asio 1.74

#include "server/connections/client.hpp"
#include "server/web/web_socket.hpp"

namespace racebeam {

using TlsStream = ByteStream::TlsStream;

// A Stream is a Socket, a TlsStream or a WebSocket.

// Sends at once what fits into the socket's buffer. A short reply then takes one system call, and does not
// wait for the event loop. Returns the rest, which is left to send_rest().
template <typename Stream>
std::string_view send_at_once(Stream& stream, Client& client, std::string_view text);

// Throws std::runtime_error if the client does not read it.
template <typename Stream>
Task<> send_rest(Stream& stream, Client& client, std::string_view text);
Task<> send_rest(WebSocket& stream, Client& client, std::string_view text);

// Receives bytes. Returns their number; 0: there will be no more.
template <typename Stream>
Task<std::size_t> receive(Stream& stream, Client& client, std::span<char> space);
Task<std::size_t> receive(WebSocket& stream, Client& client, std::span<char> space);

// Sends the last error when the server ends the session. Then throws std::runtime_error with the reason.
template <typename Stream>
Task<> send_farewell(Stream& stream, Client& client);
Task<> send_farewell(WebSocket& stream, Client& client);

// A message may be as long as the longest line and its end. `bytes` are without the end.
template <typename Stream>
void limit_line(Stream&, std::size_t) {}
void limit_line(WebSocket& stream, std::size_t bytes);

// A client that writes a request in pieces may delay the next one until this one is acknowledged (Nagle's
// algorithm). The system delays acknowledgements by 40 ms.
void acknowledge(Socket& socket);

}  // namespace racebeam
