// Beside this, tests/clients/test_small_screens.py compares with OpenCV and the reference.
#include "environment/observe/screen_stack.hpp"

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
constexpr std::size_t kSmallSize = 84 * 84;

void push(ScreenStack& stack, const Environment& environment, bool pooled) {
  stack.look(environment, pooled);
  stack.push();
}

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

// The digests are those of what OpenCV 4 makes with INTER_AREA of the same pixels.
TEST_CASE("A screen that grows is interpolated as OpenCV does it") {
  Bytes in(std::size_t(160 * 210));
  for (std::size_t y = 0; y < 210; ++y) {
    for (std::size_t x = 0; x < 160; ++x) in[y * 160 + x] = std::uint8_t(x * 37 + y * 91 + x * y);
  }
  const auto [width, height, expected] =
      GENERATE(table<int, int, std::uint64_t>({{224, 224, 0xb5fcf816f7f4cfafu},
                                               {320, 420, 0x6584f848f00d28a5u},
                                               {161, 84, 0x871dc228454d4841u},
                                               {84, 250, 0x9ff272c3de388dabu},
                                               {160, 211, 0xb2c2f91c99bfe474u}}));
  Bytes out(std::size_t(width * height));
  Enlargement(160, 210, width, height)(in, out);
  std::uint64_t digest = 0xcbf29ce484222325u;  // FNV-1a
  for (const std::uint8_t byte : out) digest = (digest ^ byte) * 0x100000001b3u;
  CHECK(digest == expected);
  CHECK_THROWS_WITH(Enlargement(160, 210, 513, 84), Catch::Contains("can't be enlarged to 513 x 84"));
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
  ScreenStack stack({.depth = 3}, environment);
  std::vector<Bytes> planes(2, Bytes(kSmallSize));
  for (int frame = 0; frame < 5; ++frame) {
    environment.act(0);
    push(stack, environment, false);
    ScreenStack alone({.depth = 1}, environment);
    push(alone, environment, false);
    planes.push_back(alone.bytes());
    const Bytes bytes = stack.bytes();
    for (std::size_t age = 0; age < 3; ++age) {
      const auto part = std::span(bytes).subspan(age * kSmallSize, kSmallSize);
      CHECK(std::ranges::equal(part, planes[planes.size() - 3 + age]));
    }
  }
  CHECK(planes[3] != planes[4]);
  stack.clear();
  CHECK(stack.bytes() == Bytes(3 * kSmallSize));
}

TEST_CASE("A pooled screen has of each pixel the brighter of the last two frames") {
  Environment environment = steered(plain());  // the background's colour changes with every frame
  Bytes before, now;
  for (int frame = 0; frame < 10; ++frame) {
    environment.screen_grey(before);
    environment.act(0);
    environment.screen_grey(now);
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = std::max(now[i], before[i]);
    ScreenStack pooled({.depth = 1}, environment);
    push(pooled, environment, true);
    Bytes expected(kSmallSize);
    AreaResize(160, environment.height(), 84, 84)(now, expected);
    CHECK(std::ranges::equal(pooled.bytes(), expected));
  }
}

TEST_CASE("A stack in colour has red, green and blue of each pixel, and may be as large as the screen") {
  Environment environment = steered(plain());
  environment.act(0);
  Bytes rgb;
  environment.screen_rgb(rgb);
  ScreenStack whole({.depth = 2, .width = 0, .height = 0, .rgb = true}, environment);
  push(whole, environment, false);
  const Bytes bytes = whole.bytes();
  CHECK(whole.screen_size() == rgb.size());
  CHECK(std::ranges::equal(std::span(bytes).last(rgb.size()), rgb));
  ScreenStack small({.depth = 1, .width = 40, .height = 70, .rgb = true}, environment);
  push(small, environment, false);
  const Bytes reduced = small.bytes();
  REQUIRE(reduced.size() == 40 * 70 * 3);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    Bytes plane, of_small, expected(40 * 70);
    for (std::size_t at = channel; at < rgb.size(); at += 3) plane.push_back(rgb[at]);
    for (std::size_t at = channel; at < reduced.size(); at += 3) of_small.push_back(reduced[at]);
    AreaResize(160, environment.height(), 40, 70)(plane, expected);
    CHECK(of_small == expected);
  }
}

TEST_CASE("A stack that sees only the upper rows is that of a screen without the others") {
  Environment environment = steered(plain());
  environment.act(0);
  environment.act(1);
  const bool pooled = GENERATE(false, true);
  ScreenStack upper({.depth = 1, .width = 0, .height = 0, .rgb = true, .rows = 50}, environment);
  ScreenStack small({.depth = 1, .width = 40, .height = 25, .rows = 50}, environment);
  ScreenStack all({.depth = 1, .width = 0, .height = 0, .rgb = true}, environment);
  ScreenStack grey({.depth = 1, .width = 0, .height = 0}, environment);
  for (ScreenStack* stack : {&upper, &small, &all, &grey}) push(*stack, environment, pooled);
  CHECK(upper.settings().height == 50);
  const Bytes whole = all.bytes(), plane = grey.bytes();
  CHECK(std::ranges::equal(upper.bytes(), std::span(whole).first(50 * 160 * 3)));
  Bytes reduced(40 * 25);
  AreaResize(160, 50, 40, 25)(std::span(plane).first(50 * 160), reduced);
  CHECK(small.bytes() == reduced);
  CHECK(ScreenStack({.depth = 1, .rows = 5000}, environment).settings().rows == 0);
}

TEST_CASE("A stack can be filled with its newest screen, and refuses sizes that can't be made") {
  Environment environment = steered(plain());
  environment.act(0);
  ScreenStack stack({.depth = 3}, environment);
  push(stack, environment, false);
  const Bytes zeros(2 * kSmallSize), before = stack.bytes();
  CHECK(std::ranges::equal(std::span(before).first(zeros.size()), zeros));
  stack.repeat();
  const Bytes bytes = stack.bytes();
  for (std::size_t age = 0; age < 3; ++age)
    CHECK(std::ranges::equal(std::span(bytes).subspan(age * kSmallSize, kSmallSize),
                             std::span(before).last(kSmallSize)));
  CHECK_THROWS_WITH(ScreenStack({.depth = 1, .width = 321}, environment),
                    "the width of an observation is 321; it takes 1 to 320, or 0 for the screen's own");
  CHECK_THROWS_WITH(ScreenStack({.depth = 1, .height = 8}, environment),
                    "the height of an observation is 8; it takes 9 to 420, or 0 for the screen's own");
}

TEST_CASE("An act can draw its frames from a range, and a few can run by themselves") {
  Settings settings = plain();
  settings.frame_skip = 2;
  settings.frame_skip_max = 4;
  Environment environment = steered(settings), twin = steered(settings);
  std::array<int, 5> counts{};
  for (int act = 0; act < 300; ++act) {
    const int before = environment.frame_number();
    environment.act(0);
    twin.act(0);
    const int frames = environment.frame_number() - before;
    REQUIRE((frames >= 2 && frames <= 4));
    ++counts[std::size_t(frames)];
  }
  CHECK(twin.frame_number() == environment.frame_number());
  for (int frames = 2; frames <= 4; ++frames) CHECK(counts[std::size_t(frames)] > 60);
  const int before = environment.frame_number();
  environment.act_for(7, 0);
  CHECK(environment.frame_number() == before + 7);
}

TEST_CASE("A watcher sees each frame of an act, and no frame of a reset") {
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
