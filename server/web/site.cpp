#include "server/web/site.hpp"

#include <sstream>
#include <string_view>

#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "server/web/page_files.hpp"

namespace racebeam {
namespace {

namespace http = boost::beast::http;
using http::status;

constexpr auto kText = "text/plain; charset=utf-8";
constexpr auto kPrometheusText = "text/plain; version=0.0.4; charset=utf-8";

// The page does not load anything from other sites, and other pages cannot embed it in a frame.
constexpr auto kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
    "'self'; "
    "worker-src 'self' blob:; media-src 'self' blob:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

std::string_view field(const HttpRequest& request, http::field name) {
  const auto value = request[name];
  return {value.data(), value.size()};
}

HttpResponse respond(const HttpRequest& request, status code, std::string text, const char* type = kText) {
  HttpResponse response{code, request.version()};
  response.set(http::field::content_type, type);
  response.set("X-Content-Type-Options", "nosniff");
  response.keep_alive(request.keep_alive());
  response.content_length(text.size());
  if (request.method() != http::verb::head) response.body() = std::move(text);
  return response;
}

bool takes_gzip(const HttpRequest& request) {
  return http::token_list(request[http::field::accept_encoding]).exists("gzip");
}

// A browser asks for the file each time. If it has not changed, the response is only 304 (not modified).
HttpResponse respond(const HttpRequest& request, const PageFile& file) {
  const bool is_current = field(request, http::field::if_none_match) == file.tag;
  const bool compressed = takes_gzip(request);
  std::string text = is_current ? std::string() : compressed ? file.compressed : std::string(file.bytes);
  HttpResponse response = respond(request, is_current ? status::not_modified : status::ok, std::move(text));
  response.set(http::field::content_type, std::string(file.type));
  response.set(http::field::etag, file.tag);
  response.set(http::field::cache_control, "no-cache");
  response.set(http::field::vary, "Accept-Encoding");
  response.set("Content-Security-Policy", kPolicy);
  response.set("Referrer-Policy", "no-referrer");
  if (compressed && !is_current) response.set(http::field::content_encoding, "gzip");
  return response;
}

std::optional<HttpResponse> answer_session(const HttpRequest& request, const Site& site) {
  if (!site.sessions) {
    return respond(request, status::forbidden,
                   "no sessions here: other machines can reach this address, so that sessions need "
                   "--token-file, and the line protocol\n");
  }
  if (!boost::beast::websocket::is_upgrade(request)) {
    HttpResponse response = respond(request, status::upgrade_required, "/session takes a WebSocket\n");
    response.set(http::field::upgrade, "websocket");
    response.set(http::field::connection, "upgrade");
    return response;
  }
  const std::string_view origin = field(request, http::field::origin);
  if (request.count(http::field::origin) > 0 &&
      !admits(*site.sessions, origin, field(request, http::field::host))) {
    return respond(request, status::forbidden,
                   "a page of this origin may not open sessions; --allow-origin allows it\n");
  }
  return std::nullopt;
}

HttpResponse answer_operator(const HttpRequest& request, const OperatorPages& pages, std::string_view path) {
  if (path == "/healthz") return respond(request, status::ok, "ok\n");
  if (path == "/metrics") return respond(request, status::ok, pages.metrics(), kPrometheusText);
  if (path != "/readyz") {
    return respond(request, status::not_found, "accepted: /, /session, /healthz, /readyz and /metrics\n");
  }
  if (pages.ready()) return respond(request, status::ok, "ready\n");
  return respond(request, status::service_unavailable, "stopping\n");
}

}  // namespace

std::optional<HttpResponse> answer(const HttpRequest& request, const Site& site) {
  const std::string_view target(request.target().data(), request.target().size());
  const std::string_view path = target.substr(0, target.find('?'));
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    HttpResponse response = respond(request, status::method_not_allowed, "only GET and HEAD\n");
    response.set(http::field::allow, "GET, HEAD");
    return response;
  }
  if (path == "/session") return answer_session(request, site);
  if (const PageFile* const file = find_page_file(path)) return respond(request, *file);
  if (site.pages) return answer_operator(request, *site.pages, path);
  return respond(request, status::not_found, "accepted: / and /session\n");
}

HttpResponse refuse(status code, const std::string& sentence) {
  HttpResponse response = respond({}, code, sentence + "\n");
  response.keep_alive(false);
  return response;
}

std::string http_refusal(const std::string& sentence) {
  std::ostringstream text;
  text << refuse(status::service_unavailable, sentence);
  return text.str();
}

}  // namespace racebeam
