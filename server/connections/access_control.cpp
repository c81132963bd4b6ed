#include "server/connections/access_control.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/operation/log.hpp"

namespace racebeam {
namespace {

using namespace std::chrono_literals;

// The longest delay of an answer to a wrong token: it must come before the handshake's timeout.
WrongTokens::Delay longest_delay(const ServerSettings& settings) {
  return std::min<WrongTokens::Delay>(5s, 500ms * settings.handshake_seconds);
}

template <typename Part>
void read_part_again(std::optional<Part>& part, const std::string& what) {
  if (!part) return;
  try {
    part->read_again();
    log("read the " + what + " again");
  } catch (const std::exception& error) {
    log_warning(std::string(error.what()) + "; the old " + what + " stays in use");
  }
}

}  // namespace

AccessControl::AccessControl(const ServerSettings& settings, const Services& services,
                             const std::string& own_token)
    : settings_(settings), services_(services), wrong_tokens_(longest_delay(settings)) {
  if (!settings.token_file.empty() || !own_token.empty()) tokens_.emplace(settings.token_file, own_token);
  if (!settings.tls_certificate.empty()) tls_.emplace(settings.tls_certificate, settings.tls_key);
  if (tokens_ && services.line) {
    guarded_ = services.line;
    std::get<LineService>(*guarded_).admission = [this](std::string_view token) {
      return tokens_->admits(token);
    };
  }
  site_.sessions = session_rules(true);  // an address beyond loopback is refused without tokens
}

void AccessControl::read_again() {
  read_part_again(tokens_, "token file");
  read_part_again(tls_, "certificate");
}

std::optional<OriginRules> AccessControl::session_rules(bool is_loopback) const {
  if (!services_.line || !(is_loopback || tokens_)) return std::nullopt;
  return OriginRules{settings_.allowed_origins, tokens_.has_value()};
}

}  // namespace racebeam
