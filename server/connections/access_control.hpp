// Decides who may open a session: tokens, the certificate, and origins of pages. Sessions refer to it, so it
// must outlive the loops that they run on.
#pragma once

#include <optional>
#include <string>
#include <utility>  // needed by Asio 1.74

#include "server/access/tls.hpp"
#include "server/access/tokens.hpp"
#include "server/access/wrong_tokens.hpp"
#include "server/connections/service.hpp"
#include "server/connections/settings.hpp"
#include "server/web/site.hpp"

namespace racebeam {

class AccessControl {
 public:
  // own_token: a token that is admitted besides those of the token file, or empty. The other parameters must
  // outlive this object. Throws std::runtime_error if a file is wrong.
  AccessControl(const ServerSettings& settings, const Services& services, const std::string& own_token);
  AccessControl(const AccessControl&) = delete;
  AccessControl& operator=(const AccessControl&) = delete;

  void read_again();  // tokens and certificate; errors are logged, and the old ones stay in use

  bool requires_token() const { return tokens_.has_value(); }
  const Service& guarded() const {
    return guarded_ ? *guarded_ : *services_.line;
  }  // a client needs a token, if one is required
  bool guards(const Service& service) const { return guarded_ && &service == &*guarded_; }
  const std::optional<Tls>& tls() const { return tls_; }
  const Site& site() const { return site_; }  // of ws:// and wss:// addresses
  WrongTokens& wrong_tokens() { return wrong_tokens_; }

  // Returns the rules for pages that open a session over HTTP. Returns nothing if no page may: other machines
  // can reach the server and it does not require a token, or it does not speak the line protocol.
  std::optional<OriginRules> session_rules(bool is_loopback) const;

 private:
  const ServerSettings& settings_;
  const Services& services_;
  std::optional<Tokens> tokens_;
  WrongTokens wrong_tokens_;
  std::optional<Tls> tls_;
  std::optional<Service> guarded_;  // the line protocol, with tokens required
  Site site_;
};

}  // namespace racebeam
