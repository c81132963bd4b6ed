// A stack that looks only at what has changed holds what one holds that looks at everything.
#include <algorithm>
#include <catch2/catch.hpp>
#include <list>
#include <random>

#include "environment/observe/screen_stack.hpp"
#include "tests/environment/observe/whole_stack.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/random_image.hpp"
#include "tests/support/roms.hpp"

namespace racebeam {
namespace {

using test::Bytes;
using test::WholeStack;

constexpr StackSettings kShapes[] = {{.depth = 4},
                                     {.depth = 1},
                                     {.depth = 1, .rgb = true},
                                     {.depth = 2, .width = 40, .height = 70, .rgb = true},
                                     {.depth = 3, .width = 160, .height = 100},
                                     {.depth = 2, .width = 96, .height = 50, .rows = 100},
                                     {.depth = 2, .width = 160, .height = 100, .rgb = true, .rows = 100},
                                     {.depth = 2, .width = 200, .height = 90},
                                     {.depth = 3, .width = 84, .height = 9}};

struct Pair {
  Pair(const StackSettings& settings, const Environment& environment)
      : swift(settings, environment), whole(settings, environment) {}

  ScreenStack swift;
  WholeStack whole;
};

// Does the same to both stacks.
template <typename Do>
void both(Pair& pair, Do act) {
  act(pair.swift);
  act(pair.whole);
}

// Two machines change places and states, so that pictures of both are seen.
void play(const std::shared_ptr<const Image>& image, const std::shared_ptr<const Game>& game,
          Settings settings, int steps, unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&random](unsigned below) { return static_cast<unsigned>(random()) % below; };
  settings.frame_skip = 1;
  Environment one(image, game, settings), other(image, game, settings);
  std::list<Pair> pairs;
  for (const StackSettings& shape : kShapes) pairs.emplace_back(shape, one);
  std::vector<std::shared_ptr<const Environment::Saved>> saved{one.save(true)};
  const auto& legal = game->legal_actions;
  for (int step = 0; step < steps; ++step) {
    one.set_drawing(static_cast<Drawing>(draw(4)));
    for (unsigned acts = draw(4); acts > 0; --acts) one.act(legal[draw(static_cast<unsigned>(legal.size()))]);
    if (draw(20) == 0) saved.push_back(draw(3) == 0 ? one.save_without_pictures() : one.save(true));
    if (draw(20) == 0) one.restore(*saved[draw(static_cast<unsigned>(saved.size()))]);
    if (draw(30) == 0) std::swap(one, other);
    if (draw(30) == 0) other.restore(*one.save(true));
    if (draw(60) == 0) one.reset_game();
    if (draw(60) == 0) one.release_caches();
    if (draw(200) == 0) one.reload(static_cast<std::uint32_t>(seed + draw(3)));
    const bool pooled = draw(3) != 0;
    const unsigned what = draw(32);
    for (Pair& pair : pairs) {
      if (what == 0) both(pair, [](auto& stack) { stack.clear(); });
      if (what == 1) both(pair, [](auto& stack) { stack.repeat(); });
      if (what == 2) both(pair, [&](auto& stack) { stack.pool_with_previous(one); });
      if (what == 3) {
        Bytes bytes = pair.whole.bytes();
        std::ranges::generate(bytes, [&] { return static_cast<std::uint8_t>(random()); });
        both(pair, [&](auto& stack) { stack.set_bytes(bytes); });
      }
      if (what > 4) both(pair, [&](auto& stack) { stack.look(one, pooled); });
      if (what != 5) both(pair, [](auto& stack) { stack.push(); });
      REQUIRE(pair.swift.bytes() == pair.whole.bytes());
    }
  }
}

TEST_CASE("A stack that skips unchanged rows equals one that reads all: pictures that change and repeat") {
  const bool averaging = GENERATE(false, true);
  Settings settings = test::plain();
  settings.color_averaging = averaging;
  play(load_image("builtin:beamfall"), find_game("beamfall"), settings, 400, 1);
  play(test::counter_image(), test::game(), settings, 200, 2);
}

TEST_CASE("A stack that skips unchanged rows equals one that reads all: random programs") {
  for (const std::string_view scheme : test::random_schemes()) {
    INFO(scheme);
    play(test::random_image(scheme, 7), test::random_game(scheme), test::plain(), 60, 3);
  }
}

TEST_CASE("A stack that skips unchanged rows equals one that reads all: commercial games") {
  // Objects that flicker, many changes within lines, PAL colours, and few changes.
  for (const char* name : {"beam_rider", "asteroids", "pitfall2", "qbert", "freeway"}) {
    const auto game = find_game(name);
    const auto image = test::find_rom_of(*game);
    if (image == nullptr) continue;
    INFO(name);
    play(image, game, test::plain(), 300, 4);
  }
}

TEST_CASE("Only wanted rows are resized, whichever rows they are") {
  std::mt19937 random(5);
  for (const auto& [height, to_height] : {std::pair{210, 84}, {210, 210}, {228, 9}, {250, 100}}) {
    Bytes in(static_cast<std::size_t>(kScreenWidth * height));
    std::ranges::generate(in, [&] { return static_cast<std::uint8_t>(random()); });
    for (int row = 1; row < height; ++row) {
      if (random() % 2 == 0)
        std::copy_n(&in[static_cast<std::size_t>((row - 1) * kScreenWidth)], kScreenWidth,
                    &in[static_cast<std::size_t>(row * kScreenWidth)]);
    }
    for (const Simd form : {Simd::kPlain, simd()}) {
      const AreaResize resize(kScreenWidth, height, 84, to_height, form);
      Bytes all(static_cast<std::size_t>(84 * to_height));
      resize(in, all);
      for (int round = 0; round < 20; ++round) {
        Bytes rows(static_cast<std::size_t>(to_height)), out(all.size(), 77);
        std::ranges::generate(rows, [&] { return static_cast<std::uint8_t>(random() % 3 == 0 ? 1 : 0); });
        resize(in, out, rows);
        for (std::size_t at = 0; at < out.size(); ++at)
          if (out[at] != (rows[at / 84] != 0 ? all[at] : 77)) FAIL("row " << at / 84);
      }
    }
  }
}

}  // namespace
}  // namespace racebeam
