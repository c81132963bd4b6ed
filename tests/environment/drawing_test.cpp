// Environment::set_drawing() does not affect what can be observed, at any time.
#include <catch2/catch.hpp>
#include <random>

#include "environment/saved/saved_state_format.hpp"
#include "tests/support/counter_image.hpp"
#include "tests/support/needed_rom.hpp"
#include "tests/support/observation.hpp"

namespace racebeam {
namespace {

std::vector<std::uint8_t> bytes_of(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

// Machines with all settings of drawing behave the same. From time to time, their pictures are compared.
void check(const std::shared_ptr<const Image>& image, const std::shared_ptr<const Game>& game, bool averaging,
           int acts) {
  Settings settings;
  settings.frame_skip = 1;
  settings.frame_skip_max = 4;
  settings.color_averaging = averaging;
  std::vector<Environment> machines;
  for (const Drawing drawing : {Drawing::kEvery, Drawing::kLastTwo, Drawing::kLast, Drawing::kNone}) {
    machines.emplace_back(image, game, settings);
    machines.back().set_drawing(drawing);
  }
  std::mt19937 random(1);
  const auto& legal = game->legal_actions;
  std::vector<std::shared_ptr<const Environment::Saved>> saved;
  for (int i = 0; i < acts; ++i) {
    const int action = legal[random() % legal.size()];
    const bool looks = random() % 8 == 0, looks_back = random() % 8 == 0, saves = random() % 50 == 0,
               loads = random() % 50 == 0;
    std::vector<std::vector<std::uint8_t>> screens, seen_before, states;
    for (Environment& machine : machines) {
      machine.act(action);
      if (looks) screens.push_back(bytes_of(machine.screen()));
      if (looks_back) seen_before.push_back(bytes_of(machine.previous_screen()));
      if (saves) saved.push_back(machine.save(true));
      if (saves) states.push_back(to_bytes(*saved.back(), machine));
      if (machine.game_over()) machine.reset_game();
    }
    if (loads && !saved.empty()) {
      for (std::size_t m = 0; m < machines.size(); ++m)
        machines[m].restore(*saved[saved.size() - machines.size() + m]);
    }
    for (const auto* list : {&screens, &seen_before, &states})
      for (const auto& one : *list) REQUIRE(one == list->front());
  }
}

TEST_CASE("Which frames are drawn has no observable effect") {
  for (const bool averaging : {false, true}) check(test::counter_image(), test::game(), averaging, 500);
}

TEST_CASE("Which frames of a commercial game are drawn has no observable effect") {
  for (const char* name :
       {"seaquest", "pong", "tetris", "montezuma_revenge", "elevator_action", "journey_escape", "robotank"}) {
    const auto game = find_game(name);
    const auto image = test::needed_rom_of(name);
    if (!image) continue;
    INFO(name);
    check(image, game, false, 200);
  }
}

TEST_CASE("A watcher sees each frame drawn, whatever is drawn otherwise") {
  Settings settings;
  settings.frame_skip = 4;
  Environment each(test::counter_image(), test::game(), settings);
  settings.frame_skip = 1;
  Environment single(test::counter_image(), test::game(), settings);
  std::vector<std::vector<std::uint8_t>> screens;
  each.set_drawing(Drawing::kNone);
  each.watch([&] { screens.push_back(bytes_of(each.screen())); });
  for (int i = 0; i < 10; ++i) each.act(0);
  REQUIRE(screens.size() == 40);
  for (const auto& screen : screens) {
    single.act(0);
    REQUIRE(bytes_of(single.screen()) == screen);
  }
}

TEST_CASE("A state that another game's machine could not restore is not made into bytes by it") {
  Environment one(test::counter_image(), test::game(), {}),
      other(test::counter_image(), test::game(test::kSteeredGame, "other"), {});
  CHECK_THROWS_WITH(to_bytes(*one.save(), other), Catch::Contains("the state is of the game steered"));
}

}  // namespace
}  // namespace racebeam
