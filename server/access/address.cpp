#include "server/access/address.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/ip/address.hpp>

#include "system/printable.hpp"
#include "system/program/sockets.hpp"

namespace racebeam {
namespace {

constexpr std::string_view kClassic = "classic+", kTls = "tls+", kTlsScheme = "tls://", kWeb = "ws://",
                           kWebTls = "wss://";
constexpr std::string_view kTcp = "tcp://", kUnix = "unix:", kSystemd = "systemd",
                           kPipes = "pipes:", kStdio = "stdio";

bool cut(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

std::optional<std::uint16_t> parse_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole ? std::optional(port) : std::nullopt;
}

// RFC 1123, 2.1, and the underscores of some containers. A last label of only digits belongs to an IP
// address.
bool is_host_name(std::string_view text) {
  constexpr std::size_t kLongest = 253;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto is_sign = [&](char c) {
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '.' ||
           c == '_';
  };
  const std::string_view last = text.substr(text.rfind('.') + 1);
  return text.size() <= kLongest && std::ranges::all_of(text, is_sign) && !text.starts_with('-') &&
         !text.starts_with('.') && !last.empty() && !std::ranges::all_of(last, is_digit);
}

std::optional<TcpAddress> parse_tcp(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto port = parse_port(text.substr(colon + 1));
  std::string host(text.substr(0, colon));
  const bool in_brackets = host.starts_with('[') && host.ends_with(']');  // an IP address
  if (in_brackets)
    host = host.substr(1, host.size() - 2);
  else if (host == "localhost")
    host = "127.0.0.1";
  if (!port || !(is_ip_address(host) || (!in_brackets && is_host_name(host)))) return std::nullopt;
  return TcpAddress{host, *port};
}

// A path may have the form of a URL: unix:///run/s stands for /run/s. unix:////run/s does so, too: the result
// must not begin with two slashes.
std::string path_of(std::string_view text) {
  cut(text, "//");
  while (text.starts_with("//")) text.remove_prefix(1);
  return std::string(text);
}

std::optional<Address> parse_address(std::string_view text) {
  if (text == kStdio) return StandardStreams{};
  if (text == kSystemd) return InheritedAddress{};
  if (cut(text, kTcp)) {
    if (auto address = parse_tcp(text)) return *address;
    return std::nullopt;
  }
  const bool inherited = text.starts_with("systemd:"), pipes = text.starts_with(kPipes);
  const bool local = text.starts_with(kUnix);
  if (!inherited && !pipes && !local) return std::nullopt;
  const std::string rest = path_of(text.substr(text.find(':') + 1));
  if (rest.empty()) return std::nullopt;
  if (inherited) return InheritedAddress{rest};
  if (pipes) return Pipes{rest};
  return UnixAddress{rest};
}

struct Writer {
  std::string operator()(const TcpAddress& address) const {
    const bool colons = address.host.find(':') != std::string::npos;
    return std::string(kTcp) + (colons ? "[" + address.host + "]" : address.host) + ":" +
           std::to_string(address.port);
  }
  std::string operator()(const UnixAddress& address) const { return std::string(kUnix) + address.path; }
  std::string operator()(const InheritedAddress& address) const {
    return std::string(kSystemd) + (address.name.empty() ? "" : ":" + address.name);
  }
  std::string operator()(StandardStreams) const { return std::string(kStdio); }
  std::string operator()(const Pipes& pipes) const { return std::string(kPipes) + pipes.prefix; }
  std::string operator()(AlePipes) const { return "pipes:ale_fifo"; }
};

// ws://HOST:PORT and wss://HOST:PORT.
std::optional<Endpoint> parse_web(std::string_view text) {
  const bool tls = text.starts_with(kWebTls);
  if (!cut(text, tls ? kWebTls : kWeb)) return std::nullopt;
  const auto address = parse_tcp(text);
  if (!address) return std::nullopt;
  return Endpoint{*address, false, tls, true};
}

// The scheme of a TCP address.
std::string_view scheme_of(const Endpoint& endpoint) {
  if (endpoint.web) return endpoint.tls ? kWebTls : kWeb;
  return endpoint.tls ? kTlsScheme : kTcp;
}

void refuse_missing_kind(const std::string& text, const Address& address) {
  const bool is_anywhere =
      std::holds_alternative<TcpAddress>(address) || std::holds_alternative<StandardStreams>(address);
  if (is_anywhere || has_local_channels()) return;
  throw std::invalid_argument(
      "'" + printable(text) +
      "' is not an address to listen on with Windows, where racebeam has neither Unix "
      "sockets nor named pipes nor systemd; accepted: tcp://HOST:PORT, tls://HOST:PORT, "
      "ws://HOST:PORT, wss://HOST:PORT and stdio");
}

}  // namespace

Endpoint parse_endpoint(const std::string& text) {
  if (const auto web = parse_web(text)) return *web;
  std::string_view rest = text;
  Endpoint endpoint;
  endpoint.classic = cut(rest, kClassic);
  endpoint.tls = cut(rest, kTls);
  std::string in_full(rest);
  if (!endpoint.tls && cut(rest, kTlsScheme)) {
    endpoint.tls = true;
    (in_full = kTcp) += rest;
  }
  const auto address = parse_address(in_full);
  if (address) refuse_missing_kind(text, *address);
  if (address && !(endpoint.tls && is_stream(*address))) {
    endpoint.address = *address;
    return endpoint;
  }
  throw std::invalid_argument(
      "'" + printable(text) +
      "' is not an address to listen on; accepted: tcp://HOST:PORT, tls://HOST:PORT, ws://HOST:PORT and "
      "wss://HOST:PORT (an IP address or a host name; port 0 picks a free one), unix:PATH, systemd or "
      "systemd:NAME, stdio and pipes:PREFIX; "
      "classic+ before an address selects the classic protocol");
}

TcpAddress parse_host_and_port(const std::string& text) {
  if (const auto address = parse_tcp(text)) return *address;
  throw std::invalid_argument(
      "'" + printable(text) +
      "' is not HOST:PORT, with an IP address or a host name; port 0 picks a free one");
}

std::string to_string(const Address& address) { return std::visit(Writer{}, address); }

std::string to_string(const Endpoint& endpoint) {
  std::string text = to_string(endpoint.address);
  if (text.starts_with(kTcp)) {
    text.replace(0, kTcp.size(), scheme_of(endpoint));
  } else if (endpoint.tls) {
    text.insert(0, kTls);
  }
  return (endpoint.classic ? "classic+" : "") + text;
}

bool is_ip_address(const std::string& host) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(host, error);
  // Windows also reads short forms of IPv4, such as 127.1. Other systems refuse them.
  return !error && (address.is_v6() || address.to_string() == host);
}

bool is_stream(const Address& address) {
  return std::holds_alternative<StandardStreams>(address) || std::holds_alternative<Pipes>(address) ||
         std::holds_alternative<AlePipes>(address);
}

bool is_loopback(const std::string& host) { return boost::asio::ip::make_address(host).is_loopback(); }

}  // namespace racebeam
