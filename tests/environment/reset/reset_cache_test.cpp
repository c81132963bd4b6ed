// A copied reset equals one that was run, for every game with an image.
#include "environment/reset/reset_cache.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "environment/saved_state.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/observation.hpp"
#include "tests/support/roms.hpp"
#include "tests/support/skip.hpp"

namespace racebeam {
namespace {

using test::observe;

Settings with_copies(bool copies) {
  Settings settings;
  settings.random_seed = 31;
  settings.sound = true;
  settings.copy_resets = copies;
  return settings;
}

void require_same(const Environment& one, const Environment& other) {
  REQUIRE(observe(one) == observe(other));
  REQUIRE(one.same_state(other));
  REQUIRE(std::ranges::equal(one.previous_screen(), other.previous_screen()));
  REQUIRE(one.sound().registers == other.sound().registers);
}

// Plays both machines in the same way, alters RAM, resets, and compares; then again.
void check_resets(const std::shared_ptr<const Image>& image, const std::shared_ptr<const Game>& game,
                  int resets) {
  INFO(game->name);
  Environment copied(image, game, with_copies(true)), run(image, game, with_copies(false));
  std::mt19937 random(5);
  const auto both = [&](auto action) { action(copied), action(run); };
  for (int reset = 0; reset < resets; ++reset) {
    for (auto acts = 5 + random() % 60; acts > 0; --acts) {
      const int action = game->legal_actions[random() % game->legal_actions.size()];
      both([action](Environment& e) { e.act(action); });
    }
    if (reset % 3 == 2) {
      const auto seed = random();
      both([seed](Environment& e) {
        std::mt19937 bytes(seed);
        for (int i = 0; i < kRamSize; ++i) e.set_ram(i, static_cast<std::uint8_t>(bytes()));
      });
    }
    if (reset % 4 == 3) both([&](Environment& e) { e.set_difficulty(game->difficulties.back()); });
    both([](Environment& e) { e.reset_game(); });
    require_same(copied, run);
  }
  for (int frame = 0; frame < 60; ++frame) {
    both([&](Environment& e) {
      e.act(game->legal_actions[static_cast<std::size_t>(frame) % game->legal_actions.size()]);
    });
    require_same(copied, run);
  }
}

TEST_CASE("A copied reset of our own image is what a run one is") {
  check_resets(test::counter_image(), test::game(), 30);
}

TEST_CASE("A copied reset of every game is what a run one is") {
  int games = 0;
  for (const CatalogueEntry& entry : catalogue()) {
    const auto game = find_game(entry.name);
    const auto image = test::find_rom_of(*game);
    if (!image) continue;
    check_resets(image, game, 8);
    ++games;
  }
  if (games == 0) test::leave_out("no images in RACEBEAM_ROMS or .venv");
}

TEST_CASE("The resets that are kept are bounded, and the ones that were used last stay") {
  ResetCache cache;
  ResetStart start;
  for (std::size_t i = 0; i < ResetCache::kMax + 10; ++i) {
    start.mode = 0;
    if (i > 0) REQUIRE(cache.find(start));
    start.mode = static_cast<std::int32_t>(i);
    ResetEnd end;
    end.frames = static_cast<std::uint32_t>(i);
    cache.keep(start, end);
    REQUIRE(cache.find(start)->frames == i);
  }
  CHECK(cache.size() == ResetCache::kMax);
  start.mode = 1;
  CHECK_FALSE(cache.find(start));
  start.mode = 0;
  CHECK(cache.find(start));
}

TEST_CASE("A smaller capacity drops the resets that were not used for longest") {
  ResetCache cache;
  ResetStart start;
  for (start.mode = 0; start.mode < 10; ++start.mode) cache.keep(start, {});
  start.mode = 2;
  REQUIRE(cache.find(start));
  cache.set_capacity(3);
  CHECK(cache.size() == 3);
  for (const std::int32_t mode : {2, 8, 9}) {
    start.mode = mode;
    CHECK(cache.find(start));
  }
  start.mode = 10;
  cache.keep(start, {});
  CHECK(cache.size() == 3);
  cache.set_capacity(0);
  CHECK(cache.size() == 1);
}

TEST_CASE("A reset is shared only by those that agree in all that decides it") {
  const ResetStart start{test::counter_image(), std::make_shared<const Game>(), {10, 20}, 1, 2, {3}, {}};
  const auto with = [&start](auto change) {
    ResetStart other = start;
    change(other);
    return other;
  };
  const std::vector<ResetStart> others = {
      with([](auto& other) { other.image = std::make_shared<const Image>(*other.image); }),
      with([](auto& other) { other.game = std::make_shared<const Game>(*other.game); }),
      with([](auto& other) { other.limits.min = 11; }),
      with([](auto& other) { other.limits.max = 21; }),
      with([](auto& other) { other.mode = 2, other.difficulty = 1; }),
      with([](auto& other) { other.mode = 3; }),
      with([](auto& other) { other.difficulty = 3; }),
      with([](auto& other) { other.sound[5] = 1; }),
      with([](auto& other) { other.machine.riot.ram[127] = 1; }),
  };
  ResetCache cache;
  cache.keep(start, {});
  CHECK(cache.find(start));
  for (const ResetStart& other : others) {
    CHECK_FALSE(cache.find(other));
    CHECK(other.hash() != start.hash());
    CHECK_FALSE(other == start);
  }
}

// A game in which the reset counts: its reward is the number of resets.
constexpr auto kCountsResets = R"(
title = "Counts"
[rule]
reset = { fresh = 1 }
keep = ["resets"]
step = """
resets = resets + fresh
fresh = 0
reward = resets
terminal = 0
"""
)";

TEST_CASE("A reset that depends on what the rule remembers is run") {
  const auto image = test::counter_image();
  check_resets(image, test::game(kCountsResets, "counts"), 10);
}

TEST_CASE("Machines of one image with other rules or limits do not share a reset") {
  constexpr auto kStarts = R"(
title = "Starts"
start = ["FIRE"]
[rule]
step = "score = 0; terminal = 0"
)";
  const auto image = test::counter_image();
  check_resets(image, test::game(kStarts, "starts"), 3);
  check_resets(image, test::game(), 3);
  for (const int least : {-1, 200000}) {
    Settings settings = with_copies(true);
    settings.paddle_min = least;
    Environment copied(image, test::game(), settings);
    settings.copy_resets = false;
    Environment run(image, test::game(), settings);
    require_same(copied, run);
  }
}

}  // namespace
}  // namespace racebeam
