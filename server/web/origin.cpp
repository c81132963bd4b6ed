#include "server/web/origin.hpp"

#include <algorithm>
#include <charconv>

#include "server/access/address.hpp"

namespace racebeam {
namespace {

// HOST[:PORT] of an origin; empty for other texts, such as the origin `null` of a file.
std::string_view place_of(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return origin.substr(scheme.size());
  }
  return {};
}

bool is_port(std::string_view text) {
  unsigned number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() && number <= 65535;
}

// The host of HOST[:PORT]; an IPv6 address is in brackets there. Empty if the whole text is not of this form,
// as in USER@HOST.
std::string_view host_of(std::string_view place) {
  const bool six = place.starts_with('[');
  const std::size_t end = six ? place.find(']') : std::min(place.find(':'), place.size());
  if (end == std::string_view::npos) return {};
  const std::string_view host = place.substr(six, end - six), port = place.substr(end + six);
  if (!port.empty() && !(port.front() == ':' && is_port(port.substr(1)))) return {};
  if (six) return is_ip_address(std::string(host)) && host.find(':') != std::string_view::npos ? host : "";
  return host.find_first_of("@/\\?#[] ") == std::string_view::npos ? host : "";
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal(std::string_view a, std::string_view b) { return std::ranges::equal(a, b, {}, lower, lower); }

bool is_name(std::string_view host) { return !equal(host, "localhost") && !is_ip_address(std::string(host)); }

}  // namespace

bool admits(const OriginRules& rules, std::string_view origin, std::string_view host) {
  if (std::ranges::find(rules.allowed, origin) != rules.allowed.end()) return true;
  const std::string_view place = place_of(origin);
  const std::string_view own = host_of(place);
  return !own.empty() && equal(place, host) && (rules.any_name || !is_name(own));
}

bool is_origin(std::string_view text) {
  const std::string_view place = place_of(text);
  return !host_of(place).empty() && place.find('*') == std::string_view::npos;
}

}  // namespace racebeam
