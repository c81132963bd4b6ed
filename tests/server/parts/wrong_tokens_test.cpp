#include "server/access/wrong_tokens.hpp"

#include <catch2/catch.hpp>
#include <utility>

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

std::string source_of(const char* address) {
  return WrongTokens::source_of(boost::asio::ip::make_address(address));
}

}  // namespace

TEST_CASE("the delay doubles with each wrong token in a row, up to the longest") {
  WrongTokens all(1s);
  int in_a_row = 0;
  for (const auto& expected : {100ms, 200ms, 400ms, 800ms, 1000ms, 1000ms}) {
    const auto verdict = all.count("a");
    CHECK(verdict.delay == expected);
    CHECK(verdict.in_a_row == ++in_a_row);
  }
  for (int more = 0; more < 100; ++more) all.count("a");
  CHECK(all.count("a").delay == 1s);
}

TEST_CASE("the delay doubles sixteen times at most") {
  WrongTokens all(1000h);
  for (int more = 0; more < 16; ++more) all.count("a");
  CHECK(all.count("a").delay == 100ms * (1 << 16));
  CHECK(all.count("a").delay == 100ms * (1 << 16));
}

TEST_CASE("a wrong token is forgotten ten minutes after the latest one of its address") {
  WrongTokens all(1s);
  const auto start = WrongTokens::Clock::now();
  CHECK(all.count("a", start).in_a_row == 1);
  CHECK(all.count("a", start + 10min).in_a_row == 2);
  CHECK(all.count("a", start + 20min).in_a_row == 3);
  const auto verdict = all.count("a", start + 30min + 1ns);
  CHECK(verdict.in_a_row == 1);
  CHECK(verdict.delay == 100ms);
  CHECK(all.count("a", start + 31min).in_a_row == 2);
}

TEST_CASE("wrong tokens from one address delay no other") {
  WrongTokens all(1s);
  all.count("a");
  CHECK(all.count("b").delay == 100ms);
}

TEST_CASE("a right token ends the delays of its address") {
  WrongTokens all(1s);
  all.count("a");
  all.count("b");
  all.forgive("a");
  CHECK(all.count("a").in_a_row == 1);
  CHECK(all.count("b").in_a_row == 2);
}

TEST_CASE("many addresses take no more than some memory, and the latest are known") {
  WrongTokens all(1s);
  for (int number = 0; number < 10000; ++number) all.count(std::to_string(number));
  CHECK(all.count("9999").in_a_row == 2);
  CHECK(all.count("0").in_a_row == 1);
}

TEST_CASE("the wrong tokens of 4096 addresses are known") {
  for (const auto& [others, known] : {std::pair(4095, 2), std::pair(4096, 1)}) {
    WrongTokens all(1s);
    all.count("first");
    for (int number = 0; number < others; ++number) all.count(std::to_string(number));
    CHECK(all.count("first").in_a_row == known);
  }
}

TEST_CASE("attempts count each wrong token once") {
  WrongTokens all(1s);
  TokenAttempts one(all, "a"), other(all, "a");
  CHECK(one.update(0).more == 0);
  const auto [more, in_a_row, delay] = one.update(2);
  CHECK(more == 2);
  CHECK(in_a_row == 2);
  CHECK(delay == 100ms + 200ms);
  CHECK(one.update(2).delay == 0ms);
  CHECK(other.update(1).in_a_row == 3);
  other.admitted();
  CHECK(one.update(3).in_a_row == 1);
}

TEST_CASE("the source is an address of IPv4, or 64 bits of one of IPv6") {
  CHECK(source_of("10.1.2.3") == "10.1.2.3");
  CHECK(source_of("::ffff:10.1.2.3") == "10.1.2.3");
  CHECK(source_of("2001:db8:1:2:3:4:5:6") == source_of("2001:db8:1:2:ffff::1"));
  CHECK(source_of("2001:db8:1:2::1") != source_of("2001:db8:1:3::1"));
}
