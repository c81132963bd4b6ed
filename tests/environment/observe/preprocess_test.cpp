// Beside this, tests/clients/test_small_screens.py compares with OpenCV and the reference.
#include "environment/observe/preprocess.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

using test::plain;
using test::steered;

using Bytes = std::vector<std::uint8_t>;

// How much of [begin, end) lies in cell `cell` of the axis.
double covered(double begin, double end, int cell) {
  return std::max(0.0, std::min(end, cell + 1.0) - std::max(begin, double(cell)));
}

// The definition: the mean over an area, in double precision.
double mean(const Bytes& in, int width, int height, int to_width, int to_height, int x, int y) {
  const double wide = double(width) / to_width, high = double(height) / to_height;
  double sum = 0;
  for (int row = 0; row < height; ++row) {
    const double weight = covered(y * high, (y + 1) * high, row);
    if (weight == 0) continue;
    for (int column = 0; column < width; ++column)
      sum += weight * covered(x * wide, (x + 1) * wide, column) * in[std::size_t(row * width + column)];
  }
  return sum / (wide * high);
}

TEST_CASE("A small screen is made of means over areas") {
  std::mt19937 random(3);
  for (const int height : {210, 250, 228}) {
    Bytes in(std::size_t(160 * height)), out(kSmallSize);
    std::ranges::generate(in, [&] { return std::uint8_t(random()); });
    AreaResize(160, height, 84, 84)(in, out);
    double worst = 0;
    for (int y = 0; y < 84; ++y) {
      for (int x = 0; x < 84; ++x) {
        const double difference = out[std::size_t(y * 84 + x)] - mean(in, 160, height, 84, 84, x, y);
        worst = std::max(worst, std::fabs(difference));
      }
    }
    CHECK(worst < 0.501);
  }
}

TEST_CASE("A plane of one colour stays so, and one of the same size is copied") {
  Bytes out(kSmallSize);
  AreaResize(160, 210, 84, 84)(Bytes(160 * 210, 200), out);
  CHECK(out == Bytes(kSmallSize, 200));
  Bytes in(12);
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = static_cast<std::uint8_t>(20 * i);
  Bytes same(12);
  AreaResize(4, 3, 4, 3)(in, same);
  CHECK(same == in);
}

TEST_CASE("A stack holds the last screens, oldest first, and zeros before") {
  Environment environment = steered(plain());
  SmallScreens stack(3, environment.height());
  std::vector<Bytes> planes(2, Bytes(kSmallSize));
  for (int frame = 0; frame < 5; ++frame) {
    environment.act(0);
    stack.push(environment, false);
    SmallScreens alone(1, environment.height());
    alone.push(environment, false);
    planes.emplace_back(alone.bytes().begin(), alone.bytes().end());
    for (std::size_t age = 0; age < 3; ++age) {
      const auto part = stack.bytes().subspan(age * kSmallSize, kSmallSize);
      CHECK(std::ranges::equal(part, planes[planes.size() - 3 + age]));
    }
  }
  CHECK(planes[3] != planes[4]);
  stack.clear();
  CHECK(std::ranges::count(stack.bytes(), 0) == std::ssize(stack.bytes()));
}

TEST_CASE("A pooled screen has of each pixel the brighter of the last two frames") {
  Environment environment = steered(plain());  // the background's colour changes with every frame
  Bytes before, now;
  for (int frame = 0; frame < 10; ++frame) {
    environment.screen_grey(before);
    environment.act(0);
    environment.screen_grey(now);
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = std::max(now[i], before[i]);
    SmallScreens pooled(1, environment.height());
    pooled.push(environment, true);
    Bytes expected(kSmallSize);
    AreaResize(160, environment.height(), 84, 84)(now, expected);
    CHECK(std::ranges::equal(pooled.bytes(), expected));
  }
}

TEST_CASE("An act can draw its frames from a range, and a few can run by themselves") {
  Settings settings = plain();
  settings.frame_skip = 2;
  settings.frame_skip_max = 4;
  Environment environment = steered(settings), twin = steered(settings);
  std::array<int, 5> seen{};
  for (int act = 0; act < 300; ++act) {
    const int before = environment.frame_number();
    environment.act(0);
    twin.act(0);
    const int frames = environment.frame_number() - before;
    REQUIRE((frames >= 2 && frames <= 4));
    ++seen[std::size_t(frames)];
  }
  CHECK(twin.frame_number() == environment.frame_number());
  for (int frames = 2; frames <= 4; ++frames) CHECK(seen[std::size_t(frames)] > 60);
  const int before = environment.frame_number();
  environment.act_for(7, 0);
  CHECK(environment.frame_number() == before + 7);
}

TEST_CASE("Who watches sees each frame of an act, and none of a reset") {
  Settings settings = plain();
  settings.frame_skip = 3;
  Environment environment = steered(settings);
  std::vector<int> frames;
  environment.watch([&] { frames.push_back(environment.frame_number()); });
  environment.act(0);
  environment.reset_game();
  environment.act(0);
  environment.watch({});
  environment.act(0);
  CHECK(frames == std::vector{1, 2, 3, 4, 5, 6});
}

}  // namespace
}  // namespace racebeam
