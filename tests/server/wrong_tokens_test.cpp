#include "server/access/wrong_tokens.hpp"

#include <catch2/catch.hpp>
#include <thread>

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

std::string source_of(const char* address) {
  return WrongTokens::source_of(boost::asio::ip::make_address(address));
}

// What is left of a delay that began after `begin`. On a busy machine the test itself may take any time.
bool about(WrongTokens::Delay wait, WrongTokens::Delay expected, WrongTokens::Clock::time_point begin) {
  return wait <= expected && wait + (WrongTokens::Clock::now() - begin) >= expected;
}

}  // namespace

TEST_CASE("the pause doubles with each wrong token in a row, up to the longest") {
  WrongTokens all(1s);
  CHECK(all.wait("a") == 0ms);
  for (const auto& expected : {100ms, 200ms, 400ms, 800ms, 1000ms, 1000ms}) {
    const auto begin = WrongTokens::Clock::now();
    all.count("a");
    CHECK(about(all.wait("a"), expected, begin));
  }
  const auto begin = WrongTokens::Clock::now();
  for (int more = 0; more < 100; ++more) all.count("a");
  CHECK(about(all.wait("a"), 1s, begin));
}

TEST_CASE("tokens that come at once are looked at one at a time, after a wrong one") {
  constexpr auto kPause = 20ms;
  WrongTokens all(kPause);
  all.count("a");
  const auto begin = WrongTokens::Clock::now();
  for (int looked_at = 0; looked_at < 10;) {
    int at_once = 0;
    const auto look = WrongTokens::Clock::now();
    for (int connection = 0; connection < 10; ++connection) at_once += all.wait("a") == 0ms;
    if (WrongTokens::Clock::now() - look < kPause) CHECK(at_once <= 1);  // else the machine has paused
    looked_at += at_once;
    std::this_thread::sleep_for(1ms);
  }
  CHECK(WrongTokens::Clock::now() - begin >= 10 * kPause);
}

TEST_CASE("tokens that come at once do not wait without a wrong one") {
  WrongTokens all(1s);
  for (int connection = 0; connection < 10; ++connection) CHECK(all.wait("a") == 0ms);
}

TEST_CASE("wrong tokens from one address delay no other") {
  WrongTokens all(1s);
  all.count("a");
  CHECK(all.wait("b") == 0ms);
}

TEST_CASE("a right token ends the delay") {
  WrongTokens all(1s);
  all.count("a");
  const auto begin = WrongTokens::Clock::now();
  all.count("b");
  all.forgive("a");
  CHECK(all.wait("a") == 0ms);
  CHECK(about(all.wait("b"), 100ms, begin));
  CHECK(all.count("a") == 1);
}

TEST_CASE("many addresses take no more than some memory, and the latest are known") {
  WrongTokens all(1s);
  for (int number = 0; number < 9999; ++number) all.count(std::to_string(number));
  const auto begin = WrongTokens::Clock::now();
  all.count("9999");
  CHECK(about(all.wait("9999"), 100ms, begin));
  CHECK(all.wait("0") == 0ms);
}

TEST_CASE("a guesser counts each of its wrong tokens once") {
  WrongTokens all(1s);
  Guesser one(all, "a"), other(all, "a");
  CHECK(one.heard(0) == std::pair(0, 0));
  CHECK(one.heard(2) == std::pair(2, 2));
  CHECK(one.heard(2) == std::pair(0, 0));
  const auto begin = WrongTokens::Clock::now();
  CHECK(other.heard(1) == std::pair(1, 3));
  CHECK(about(one.wait(), 400ms, begin));
  other.admitted();
  CHECK(one.wait() == 0ms);
}

TEST_CASE("the source is an address of IPv4, or 64 bits of one of IPv6") {
  CHECK(source_of("10.1.2.3") == "10.1.2.3");
  CHECK(source_of("::ffff:10.1.2.3") == "10.1.2.3");
  CHECK(source_of("2001:db8:1:2:3:4:5:6") == source_of("2001:db8:1:2:ffff::1"));
  CHECK(source_of("2001:db8:1:2::1") != source_of("2001:db8:1:3::1"));
}
