#include "server/web/origin.hpp"

#include <algorithm>

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

std::string_view without_port(std::string_view place) {
  if (place.starts_with('[')) return place.substr(1, place.find(']') - 1);  // IPv6
  return place.substr(0, place.find(':'));
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal(std::string_view a, std::string_view b) { return std::ranges::equal(a, b, {}, lower, lower); }

bool is_name(std::string_view host) { return !equal(host, "localhost") && !is_ip_address(std::string(host)); }

}  // namespace

bool admits(const OriginRules& rules, std::string_view origin, std::string_view host) {
  if (std::ranges::find(rules.allowed, origin) != rules.allowed.end()) return true;
  const std::string_view place = place_of(origin);
  return !place.empty() && equal(place, host) && (rules.any_name || !is_name(without_port(place)));
}

bool is_origin(std::string_view text) {
  const std::string_view place = place_of(text);
  return !place.empty() && place.find_first_of("/*?# ") == std::string_view::npos;
}

}  // namespace racebeam
