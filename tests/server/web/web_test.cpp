#include <catch2/catch.hpp>
#include <string>

#include "server/web/origin.hpp"
#include "server/web/replies.hpp"

using namespace racebeam;

TEST_CASE("The origin of the server's own page has its host and port") {
  const OriginRules rules;
  CHECK(admits(rules, "http://127.0.0.1:7800", "127.0.0.1:7800"));
  CHECK(admits(rules, "https://[::1]:7800", "[::1]:7800"));
  CHECK(admits(rules, "http://localhost:7800", "LOCALHOST:7800"));
  CHECK(admits({{}, true}, "http://az:7800", "AZ:7800"));
  CHECK(admits(rules, "http://10.0.0.1", "10.0.0.1"));
  CHECK(!admits(rules, "http://127.0.0.1:7801", "127.0.0.1:7800"));
  CHECK(!admits(rules, "http://127.0.0.1", "127.0.0.1:7800"));
  CHECK(!admits(rules, "ftp://127.0.0.1:7800", "127.0.0.1:7800"));
  CHECK(!admits(rules, "null", "127.0.0.1:7800"));
  CHECK(!admits(rules, "http://", ""));
}

TEST_CASE("A page without an origin is nobody's own, also where the request has no host") {
  for (const bool any_name : {false, true}) {
    for (const std::string origin : {"null", "", "http://", "https://", "file://"}) {
      INFO(origin);
      for (const std::string host : {"", "null", "127.0.0.1:7800"})
        CHECK(!admits({{}, any_name}, origin, host));
      CHECK(!is_origin(origin));
    }
    CHECK(!admits({{}, any_name}, "http://127.0.0.1:7800", ""));
  }
}

TEST_CASE("A name is the server's own only if clients need a token") {
  for (const std::string name : {"node7:7800", "localhost.evil:1", "127.0.0.1.evil:1"}) {
    INFO(name);
    CHECK(!admits({{}, false}, "http://" + name, name));
    CHECK(admits({{}, true}, "http://" + name, name));
  }
}

TEST_CASE("A text that is more than a host and a port is nobody's own") {
  for (const std::string place :
       {"[evil]:1", "[::1].evil", "[::1]evil", "[::1].evil:1", "[::1", "[127.0.0.1]:1", "localhost@evil",
        "127.0.0.1:80@evil", "127.0.0.1:80.evil", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1",
        "127.0.0.1:80:80", "127.0.0.1/x", ":80", "[]"}) {
    INFO(place);
    CHECK(!admits({{}, false}, "http://" + place, place));
    CHECK(!admits({{}, true}, "http://" + place, place));
    CHECK(!is_origin("http://" + place));
  }
  for (const std::string place : {"[::1]", "[::1]:80", "127.0.0.1", "localhost:65535", "lab.example"})
    CHECK(is_origin("https://" + place));
}

TEST_CASE("Origins that were allowed are compared as a whole") {
  const OriginRules rules{{"https://lab.example"}, false};
  CHECK(admits(rules, "https://lab.example", "127.0.0.1:1"));
  CHECK(!admits(rules, "http://lab.example", "127.0.0.1:1"));
  CHECK(!admits(rules, "https://lab.example.evil", "127.0.0.1:1"));
}

TEST_CASE("Output is cut into replies, with the bytes that follow a line") {
  std::string_view output = "ok reward=1\nok ram=4 raw=4\n\n\nokerror bad-value x is raw=9\nok\n";
  const auto check = [&](std::string_view line, std::string_view raw) {
    const CutReply reply = cut_reply(output);
    CHECK(reply.line == line);
    CHECK(reply.raw == raw);
  };
  check("ok reward=1", "");
  check("ok ram=4 raw=4", "\n\nok");
  check("error bad-value x is raw=9", "");
  check("ok", "");
  CHECK(output.empty());
}
