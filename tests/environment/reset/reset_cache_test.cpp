// A copied reset equals one that was run, for every game with an image.
#include "environment/reset/reset_cache.hpp"

#include <catch2/catch.hpp>
#include <map>
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

// At power-on, its frames have 253 lines or 287, which a random bit of RAM decides. At the end, RAM is the
// same in both cases. From the next reset on, it counts lines in frames that only the limit of lines closes.
std::shared_ptr<const Image> image_of_random_format() {
  std::vector<std::uint8_t> rom = {
      0xA9, 0x01, 0x8D, 0x96, 0x02, 0xA5, 0x90, 0xC9, 0x5A, 0xF0, 0x55,  // TIM64T; later resets: to $F060
      0xA5, 0x80, 0x29, 0x01, 0xA8, 0xA2, 0x32,                          // the random bit; 50 frames
      0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0x85, 0x02,        // VSYNC
      0xA9, 0x00, 0x85, 0x00, 0xA9, 0xC8, 0x85, 0x81, 0x85, 0x02,        // 200 lines
      0xC6, 0x81, 0xD0, 0xFA, 0xA9, 0x32, 0xC0, 0x00, 0xF0, 0x02,        // 50 lines
      0xA9, 0x54, 0x85, 0x81, 0x85, 0x02, 0xC6, 0x81, 0xD0, 0xFA,        // or 84
      0xCA, 0xD0, 0xD5, 0xA2, 0x7F, 0xA9, 0x00, 0x95, 0x80, 0xCA,        // RAM is cleared
      0x10, 0xFB, 0xA9, 0x5A, 0x85, 0x90,                                // but for the mark of a later reset
      0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0xA9, 0x00,        // frames that leave RAM as it is
      0x85, 0x00, 0xA2, 0xFA, 0x85, 0x02, 0xCA, 0xD0, 0xFB, 0x4C, 0x4A, 0xF0,  // from $F04A on
      0x85, 0x02, 0xE6, 0x82, 0xD0, 0xFA, 0xE6, 0x83, 0x4C, 0x60, 0xF0};       // lines are counted
  rom.resize(4096);
  rom[0xFFD] = 0xF0;
  return make_image(std::move(rom), "random_format");
}

TEST_CASE("A reset is not copied from a machine in which another format was detected") {
  const auto image = image_of_random_format();
  std::map<Format, int> formats;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    INFO("system seed " << seed);
    Settings copies = with_copies(true), runs = with_copies(false);
    copies.system_seed = runs.system_seed = seed;
    const Environment copied(image, test::game(), copies), run(image, test::game(), runs);
    require_same(copied, run);
    ++formats[run.format()];
  }
  CHECK(formats.size() == 2);
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
      with([](auto& other) { other.format = Format::kPal; }),
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
