#include "server/access/address.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

using namespace racebeam;

TEST_CASE("An endpoint is written as it is read") {
  for (const std::string text : {"tcp://127.0.0.1:0",
                                 "tcp://[::1]:65535",
                                 "tls://10.0.0.1:443",
                                 "tcp://node-1.cluster:0",
                                 "tls://4you.org:1",
                                 "tcp://node_1:1",
                                 "tcp://az09.AZ:1",
                                 "tcp://9.0a:1",
                                 "unix:s",
                                 "unix:/run/s",
                                 "systemd",
                                 "systemd:name",
                                 "stdio",
                                 "pipes:/tmp/p",
                                 "classic+tcp://127.0.0.1:1",
                                 "classic+tls://127.0.0.1:1",
                                 "classic+tls+unix:s",
                                 "tls+systemd:name",
                                 "classic+stdio",
                                 "ws://127.0.0.1:0",
                                 "wss://[::1]:443",
                                 "ws://node-1:80"}) {
    CHECK(to_string(parse_endpoint(text)) == text);
  }
}

TEST_CASE("There is more than one way to write some endpoints") {
  CHECK(to_string(parse_endpoint("unix:///run/s")) == "unix:/run/s");
  CHECK(to_string(parse_endpoint("unix:////run/s")) == "unix:/run/s");
  CHECK(to_string(parse_endpoint("pipes:///////p")) == "pipes:/p");
  CHECK(to_string(parse_endpoint("pipes:///tmp/p")) == "pipes:/tmp/p");
  CHECK(to_string(parse_endpoint("tcp://localhost:1")) == "tcp://127.0.0.1:1");
  CHECK(to_string(parse_endpoint("tls+tcp://127.0.0.1:1")) == "tls://127.0.0.1:1");
}

TEST_CASE("An invalid endpoint is refused with the valid forms") {
  for (const std::string text : {"",
                                 "tcp",
                                 "tcp://",
                                 "tcp://1.2.3.4",
                                 "tcp://1.2.3.4:",
                                 "tcp://1.2.3.4:65536",
                                 "tcp://1.2.3.4:-1",
                                 "tcp://1.2.3.4:1x",
                                 "tcp://no body:1",
                                 "tcp://1.2.3:1",
                                 "tcp://-a:1",
                                 "tcp://.a:1",
                                 "tcp://a/b:1",
                                 "tcp://a@b:1",
                                 "tcp://[a:1",
                                 "tcp://a]:1",
                                 "tcp://::1:1x",
                                 "tcp://a.:1",
                                 "tcp://[a]b:1",
                                 "tcp://[localhost]:1",
                                 "unix:",
                                 "unix://",
                                 "pipes:",
                                 "systemd:",
                                 "stdio:",
                                 "tls+stdio",
                                 "tls+pipes:p",
                                 "tls+classic+unix:s",
                                 "classic+",
                                 "classic+classic+stdio",
                                 "http://127.0.0.1:1",
                                 "ws://",
                                 "wss://1.2.3.4",
                                 "ws:s",
                                 "classic+ws://127.0.0.1:1",
                                 "tls+ws://127.0.0.1:1",
                                 "a"}) {
    INFO(text);
    CHECK_THROWS_AS(parse_endpoint(text), std::invalid_argument);
  }
  CHECK_THROWS_WITH(parse_endpoint("udp://1.2.3.4:1"), Catch::Contains("accepted: tcp://HOST:PORT"));
  CHECK_THROWS_WITH(parse_endpoint("ws://[::1]:\xCF"),
                    Catch::StartsWith("'ws://[::1]:\\xcf' is not an address"));
}

TEST_CASE("A host name has 253 characters at most") {
  const std::string longest(253, 'a');
  CHECK(to_string(parse_endpoint("tcp://" + longest + ":1")) == "tcp://" + longest + ":1");
  CHECK_THROWS_AS(parse_endpoint("tcp://a" + longest + ":1"), std::invalid_argument);
}

TEST_CASE("Only loopback addresses are loopback") {
  for (const std::string host : {"127.0.0.1", "127.9.9.9", "::1"}) CHECK(is_loopback(host));
  for (const std::string host : {"0.0.0.0", "::", "10.0.0.1", "::ffff:10.0.0.1"}) CHECK(!is_loopback(host));
}
