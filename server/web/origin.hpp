// Which pages of a browser may open a session. A browser lets every page connect to every server, and tells
// the server the page's origin: SCHEME://HOST[:PORT].
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

struct OriginRules {
  std::vector<std::string> allowed;  // besides the server's own; as a browser writes them
  // Whether the server's own page may have any host name. It must not if clients do not need a token: another
  // site can make its own name resolve to this machine (DNS rebinding). Then only IP addresses and localhost
  // are allowed.
  bool any_name = false;
};

// `origin` and `host` are the fields of the request. True for the server's own page, whose origin has this
// host and port, and for origins that the rules allow.
bool admits(const OriginRules& rules, std::string_view origin, std::string_view host);

bool is_origin(std::string_view text);  // http://HOST[:PORT] or https://HOST[:PORT]

}  // namespace racebeam
