// The addresses that a server listens on, as the command line gives them.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <variant>

namespace racebeam {

// An address that the server cannot listen on: it is in use, or its host is unknown.
class AddressError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct TcpAddress {
  std::string host;  // an IP address, or a name that resolve() finds
  std::uint16_t port = 0;
};

struct UnixAddress {
  std::string path;
};

// Sockets that systemd has opened: all, or those with a name (systemd.socket(5), FileDescriptorName).
struct InheritedAddress {
  std::string name;
};

struct StandardStreams {};

// Named pipes: PREFIX_out for replies and PREFIX_in for requests. The server makes missing pipes, and removes
// these when it ends.
struct Pipes {
  std::string prefix;
};

// ale_fifo_out and ale_fifo_in, which the client creates. If ale_fifo_out is missing, the server writes a
// regular file of that name, as ALE does; if ale_fifo_in is missing, the server ends.
struct AlePipes {};

using Address = std::variant<TcpAddress, UnixAddress, InheritedAddress, StandardStreams, Pipes, AlePipes>;

struct Endpoint {
  Address address;
  bool classic = false;  // the protocol of ALE 0.4 to 0.6
  bool tls = false;
  bool web = false;  // the line protocol over WebSocket; always a TcpAddress
};

// Parses [classic+][tls+]ADDRESS, where ADDRESS is tcp://HOST:PORT, unix:PATH, systemd, systemd:NAME, stdio
// or pipes:PREFIX. tls:// is short for tls+tcp://. Also parses ws://HOST:PORT and wss://HOST:PORT, which do
// not take a prefix. Throws std::invalid_argument with a sentence.
Endpoint parse_endpoint(const std::string& text);

TcpAddress parse_host_and_port(const std::string& text);  // throws std::invalid_argument

// In the format of parse_endpoint().
std::string to_string(const Address& address);
std::string to_string(const Endpoint& endpoint);

bool is_ip_address(const std::string& host);  // false for a name
bool is_stream(const Address& address);       // whether it has a single session, over streams that block
bool is_loopback(const std::string& host);    // whether it is an IP address that only this machine can reach

}  // namespace racebeam
