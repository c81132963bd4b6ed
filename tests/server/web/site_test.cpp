// Answers to HTTP requests, without a connection.
#include "server/web/site.hpp"

#include <boost/beast/http.hpp>
#include <catch2/catch.hpp>

using namespace racebeam;
using Catch::Contains;
namespace http = boost::beast::http;

namespace {

HttpRequest request(const std::string& target, http::verb method = http::verb::get) {
  HttpRequest all{method, target, 11};
  all.set(http::field::host, "127.0.0.1:7800");
  return all;
}

HttpRequest upgrade(const std::string& origin = "") {
  HttpRequest all = request("/session");
  all.set(http::field::connection, "upgrade");
  all.set(http::field::upgrade, "websocket");
  if (!origin.empty()) all.set(http::field::origin, origin);
  return all;
}

Site site(bool ready = true) {
  return {OperatorPages{[ready] { return ready; }, [] { return std::string("racebeam_sessions_open 0\n"); }},
          OriginRules{}};
}

struct Reply {
  Reply(const HttpRequest& request, const Site& of)
      : response(answer(request, of).value()), status(response.result_int()), body(response.body()) {}

  std::string field(http::field name) const { return std::string(response[name]); }

  HttpResponse response;
  unsigned status;
  std::string body;
};

}  // namespace

TEST_CASE("the operator's pages tell whether the process lives, and whether it is ready") {
  CHECK(Reply(request("/healthz"), site(false)).status == 200);
  CHECK(Reply(request("/healthz"), site()).body == "ok\n");
  CHECK(Reply(request("/readyz"), site()).body == "ready\n");
  CHECK(Reply(request("/readyz"), site()).status == 200);
  CHECK(Reply(request("/readyz"), site(false)).body == "stopping\n");
  CHECK(Reply(request("/readyz"), site(false)).status == 503);
  const Reply metrics(request("/metrics?from=me"), site());
  CHECK(metrics.body == "racebeam_sessions_open 0\n");
  CHECK(metrics.field(http::field::content_type) == "text/plain; version=0.0.4; charset=utf-8");
}

TEST_CASE("an unknown path is refused with those that there are") {
  const Reply all(request("/none"), site());
  CHECK(all.status == 404);
  CHECK(all.body == "accepted: /, /session, /healthz, /readyz and /metrics\n");
  for (const char* path : {"/none", "/healthz", "/metrics"}) {
    const Reply few(request(path), Site{{}, OriginRules{}});
    CHECK(few.status == 404);
    CHECK(few.body == "accepted: / and /session\n");
  }
}

TEST_CASE("only GET and HEAD are accepted, and HEAD has the length of the body without it") {
  for (const http::verb method :
       {http::verb::post, http::verb::put, http::verb::delete_, http::verb::options}) {
    const Reply refused(request("/healthz", method), site());
    CHECK(refused.status == 405);
    CHECK(refused.field(http::field::allow) == "GET, HEAD");
  }
  const Reply head(request("/healthz", http::verb::head), site());
  CHECK(head.status == 200);
  CHECK(head.body.empty());
  CHECK(head.field(http::field::content_length) == "3");
}

TEST_CASE("a connection stays open as its client asks") {
  HttpRequest last = request("/healthz");
  last.keep_alive(false);
  CHECK(Reply(request("/healthz"), site()).response.keep_alive());
  CHECK_FALSE(Reply(last, site()).response.keep_alive());
  CHECK_FALSE(refuse(http::status::bad_request, "no").keep_alive());
}

TEST_CASE("a session is opened by a WebSocket whose origin is allowed or missing") {
  CHECK_FALSE(answer(upgrade(), site()));
  CHECK_FALSE(answer(upgrade("http://127.0.0.1:7800"), site()));
  const Reply other(upgrade("http://evil.example"), site());
  CHECK(other.status == 403);
  CHECK_THAT(other.body, Contains("--allow-origin"));
  HttpRequest without_origin = upgrade();
  without_origin.set(http::field::origin, "");
  CHECK(Reply(without_origin, site()).status == 403);
  const Reply plain(request("/session"), site());
  CHECK(plain.status == 426);
  CHECK(plain.field(http::field::upgrade) == "websocket");
  CHECK(plain.field(http::field::connection) == "upgrade");
  CHECK(Reply(upgrade(), Site{}).status == 403);
}

TEST_CASE("a refusal is a whole response, which closes the connection") {
  const std::string text = http_refusal("the server is full");
  CHECK_THAT(text, Catch::StartsWith("HTTP/1.1 503 Service Unavailable\r\n") &&
                       Catch::EndsWith("\r\n\r\nthe server is full\n") && Contains("Connection: close\r\n") &&
                       Contains("Content-Length: 19\r\n") && Contains("X-Content-Type-Options: nosniff\r\n"));
}
