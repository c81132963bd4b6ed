#include "server/access/wrong_tokens.hpp"

#include <catch2/catch.hpp>

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

std::string source_of(const char* address) {
  return WrongTokens::source_of(boost::asio::ip::make_address(address));
}

}  // namespace

TEST_CASE("the delay doubles with each wrong token in a row, up to the longest") {
  WrongTokens all(1s);
  CHECK(all.delay("a") == 0ms);
  for (const auto& expected : {100ms, 200ms, 400ms, 800ms, 1000ms, 1000ms}) {
    all.count("a");
    CHECK(all.delay("a") == expected);
  }
  for (int more = 0; more < 100; ++more) all.count("a");
  CHECK(all.delay("a") == 1s);
}

TEST_CASE("wrong tokens from one address delay no other") {
  WrongTokens all(1s);
  all.count("a");
  CHECK(all.delay("b") == 0ms);
}

TEST_CASE("a right token ends the delay") {
  WrongTokens all(1s);
  all.count("a");
  all.count("b");
  all.forgive("a");
  CHECK(all.delay("a") == 0ms);
  CHECK(all.delay("b") == 100ms);
  CHECK(all.count("a") == 1);
}

TEST_CASE("many addresses take no more than some memory, and the latest are known") {
  WrongTokens all(1s);
  for (int number = 0; number < 10000; ++number) all.count(std::to_string(number));
  CHECK(all.delay("9999") == 100ms);
  CHECK(all.delay("0") == 0ms);
}

TEST_CASE("a guesser counts each of its wrong tokens once") {
  WrongTokens all(1s);
  Guesser one(all, "a"), other(all, "a");
  CHECK(one.heard(0) == std::pair(0, 0));
  CHECK(one.heard(2) == std::pair(2, 2));
  CHECK(one.heard(2) == std::pair(0, 0));
  CHECK(other.heard(1) == std::pair(1, 3));
  CHECK(one.delay() == 400ms);
  other.admitted();
  CHECK(one.delay() == 0ms);
}

TEST_CASE("the source is an address of IPv4, or 64 bits of one of IPv6") {
  CHECK(source_of("10.1.2.3") == "10.1.2.3");
  CHECK(source_of("::ffff:10.1.2.3") == "10.1.2.3");
  CHECK(source_of("2001:db8:1:2:3:4:5:6") == source_of("2001:db8:1:2:ffff::1"));
  CHECK(source_of("2001:db8:1:2::1") != source_of("2001:db8:1:3::1"));
}
