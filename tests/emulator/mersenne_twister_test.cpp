// The generator gives the numbers of std::mt19937, and its state is the words of the algorithm.
#include "emulator/base/mersenne_twister.hpp"

#include <catch2/catch.hpp>
#include <random>

namespace racebeam::test {
namespace {

TEST_CASE("The generator gives the known numbers of MT19937") {
  MersenneTwister standard;
  standard.discard(9999);
  CHECK(standard() == 4123659995U);  // the C++ standard's check value, with the default seed 5489
  MersenneTwister other(123);        // docs/spec/environment.md, 17
  for (const std::uint32_t expected : {2991312382U, 3062119789U, 1228959102U, 1840268610U})
    CHECK(other() == expected);
}

TEST_CASE("The generator gives what std::mt19937 gives, for any seed and after any jump") {
  for (const std::uint32_t seed : {0U, 1U, 4753849U, 0xFFFFFFFFU}) {
    MersenneTwister own(seed);
    std::mt19937 standard(seed);
    for (std::uint32_t jump = 0; jump < 3000; jump += 7) {
      own.discard(jump);
      standard.discard(jump);
      REQUIRE(own() == standard());
    }
  }
}

TEST_CASE("A generator continues from its words and position") {
  for (const int draws : {0, 1, 623, 624, 625, 5000}) {
    MersenneTwister first(7);
    for (int i = 0; i < draws; ++i) first();
    CHECK(first.position() == (draws == 0 ? 624U : (static_cast<std::uint32_t>(draws) - 1) % 624 + 1));
    MersenneTwister second(first.words(), first.position());
    CHECK(second == first);
    for (int i = 0; i < 1300; ++i) REQUIRE(second() == first());
  }
}

}  // namespace
}  // namespace racebeam::test
