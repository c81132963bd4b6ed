#include "server/address.hpp"

#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio/ip/address.hpp>

namespace racebeam {
namespace {

constexpr std::string_view kTcp = "tcp://", kUnix = "unix:";

std::optional<std::uint16_t> parse_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole ? std::optional(port) : std::nullopt;
}

std::optional<TcpAddress> parse_tcp(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto port = parse_port(text.substr(colon + 1));
  std::string host(text.substr(0, colon));
  if (host == "localhost") host = "127.0.0.1";
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  boost::system::error_code error;
  boost::asio::ip::make_address(host, error);
  if (error || !port) return std::nullopt;
  return TcpAddress{host, *port};
}

}  // namespace

Address parse_address(const std::string& text) {
  const std::string_view view = text;
  if (view.starts_with(kTcp)) {
    if (const auto address = parse_tcp(view.substr(kTcp.size()))) return *address;
  } else if (view.starts_with(kUnix) && view.size() > kUnix.size()) {
    return UnixAddress{text.substr(kUnix.size())};
  }
  throw std::invalid_argument(
      "'" + text +
      "' is not an address to listen on; there are tcp://HOST:PORT (an IP address or localhost; "
      "port 0 picks a free one) and unix:PATH");
}

std::string to_string(const TcpAddress& address) {
  const bool colons = address.host.find(':') != std::string::npos;
  return std::string(kTcp) + (colons ? "[" + address.host + "]" : address.host) + ":" +
         std::to_string(address.port);
}

}  // namespace racebeam
