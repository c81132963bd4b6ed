#include "agents/experiment/settling_rate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

using namespace racebeam;

namespace {

struct Measured {
  double rate, seconds;
};

// Measures what takes seconds_at(time) seconds.
Measured measure(const std::function<double(double)>& seconds_at, double least, double most) {
  SettlingRate rate(least, most);
  double now = 0;
  do now += seconds_at(now);
  while (!rate.add(now));
  return {rate.rate(), now};
}

}  // namespace

TEST_CASE("What goes at one speed is measured for the least time") {
  const Measured measured = measure([](double) { return 0.001; }, 0.4, 3.2);
  CHECK(measured.rate == Approx(1000).epsilon(0.02));
  CHECK(measured.seconds == Approx(0.4).margin(0.002));
}

TEST_CASE("What becomes faster is measured until it hardly does") {
  const auto learner = [](double now) { return 1 / (500 + 2500 * std::min(now, 1.0)); };
  const Measured measured = measure(learner, 0.4, 3.2);
  CHECK(measured.rate == Approx(3000).epsilon(0.02));
  CHECK(measured.seconds <= 3.21);
  CHECK(measure(learner, 0.4, 0.4).rate < 1500);  // the least time says too little
}

TEST_CASE("What becomes slower is measured until it hardly does") {
  const Measured measured = measure([](double now) { return now < 0.3 ? 1e-4 : 1e-3; }, 0.4, 3.2);
  CHECK(measured.rate == Approx(1000).epsilon(0.02));
}

TEST_CASE("A speed that never settles is measured for the most time") {
  const Measured measured = measure([](double now) { return 0.01 / (1 + 40 * now * now); }, 0.4, 3.2);
  CHECK(measured.seconds == Approx(3.2).margin(0.02));
}

TEST_CASE("Who waits for something else measures on, at most for the most time") {
  SettlingRate rate(0.4, 3.2);
  double now = 0;
  do now += 0.001;
  while (!rate.add(now, now < 1));
  CHECK(now == Approx(1.6).margin(0.01));  // the next round that ends
  CHECK(rate.rate() == Approx(1000).epsilon(0.02));
}

TEST_CASE("One that takes longer than the most time is enough") {
  const Measured measured = measure([](double) { return 5.0; }, 0.4, 3.2);
  CHECK(measured.rate == Approx(0.2));
  CHECK(measured.seconds == 5);
}
