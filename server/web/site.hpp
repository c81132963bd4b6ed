// What a server offers over HTTP, and the answers to requests.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>  // needed by Asio 1.74

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/web/origin.hpp"

namespace racebeam {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;
using HttpResponse = boost::beast::http::response<boost::beast::http::string_body>;

// For the operator. /healthz: 200 while the process lives. /readyz: 200, or 503 after the server was told to
// stop. /metrics: for Prometheus.
struct OperatorPages {
  std::function<bool()> ready;
  std::function<std::string()> metrics;
};

// What the server offers besides the page for users, which is always there.
struct Site {
  std::optional<OperatorPages> pages;
  std::optional<OriginRules> sessions;  // for pages that open a session at /session; nothing: no page may
};

// Returns the response; nothing if the request opens a session, so that the connection becomes a WebSocket.
// Thread-safe if the functions of the site are.
std::optional<HttpResponse> answer(const HttpRequest& request, const Site& site);

// A response to a client whose request the server does not read.
HttpResponse refuse(boost::beast::http::status code, const std::string& sentence);
std::string http_refusal(const std::string& sentence);  // the text of a response with the status 503

}  // namespace racebeam
