#include "agents/base/random.hpp"

#include <catch2/catch.hpp>
#include <map>

using racebeam::Random;

TEST_CASE("The generator gives the published numbers of SplitMix64") {
  Random random(1234567);
  CHECK(random.next() == 6457827717110365317U);
  CHECK(random.next() == 3203168211198807973U);
  CHECK(random.next() == 9817491932198370423U);
}

TEST_CASE("Numbers below a bound are as likely as each other") {
  Random random(1);
  std::map<std::size_t, int> counts;
  for (int i = 0; i < 18000; ++i) ++counts[random.below(18)];
  CHECK(counts.size() == 18);
  for (const auto& [number, count] : counts) {
    CHECK(number < 18);
    CHECK(count == Approx(1000).margin(150));
  }
}

TEST_CASE("Uniform numbers are from 0 to below 1") {
  Random random(2);
  double sum = 0;
  for (int i = 0; i < 10000; ++i) {
    const double number = random.uniform();
    REQUIRE(number >= 0);
    REQUIRE(number < 1);
    sum += number;
  }
  CHECK(sum / 10000 == Approx(0.5).margin(0.02));
}
