#include "tests/server/wire/percentile.hpp"

#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

namespace {

// 1, 2, ... `count`.
std::vector<double> first_numbers(std::size_t count) {
  std::vector<double> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 1);
  return numbers;
}

}  // namespace

TEST_CASE("percentile: it is the nearest rank, as computed by hand") {
  CHECK(wire::percentile({15, 20, 35, 40, 50}, 0.3) == 20);
  CHECK(wire::percentile({15, 20, 35, 40, 50}, 0.4) == 20);
  CHECK(wire::percentile({15, 20, 35, 40, 50}, 0.5) == 35);
  CHECK(wire::percentile({15, 20, 35, 40, 50}, 1) == 50);
  CHECK(wire::percentile(first_numbers(10), 0.99) == 10);
  CHECK(wire::percentile(first_numbers(100), 0.99) == 99);
  CHECK(wire::percentile(first_numbers(101), 0.99) == 100);
  CHECK(wire::percentile(first_numbers(100), 0.07) == 7);
  CHECK(wire::percentile({8, 9}, 0.5) == 8);
  CHECK(wire::percentile({8, 9}, 0) == 8);
  CHECK(wire::percentile({}, 0.5) == 0);
}
