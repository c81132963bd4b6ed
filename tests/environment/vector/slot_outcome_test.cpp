// What a slot says of a request: rewards, lives, ends, and whether it played.
#include "environment/vector/slot.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "tests/environment/steered.hpp"
#include "tests/environment/vector/slot_steps.hpp"

namespace racebeam {
namespace {

using test::cartridge, test::lose_life, test::no_noops;

SlotSettings acts(LifeLoss life_loss = LifeLoss::kIgnored) {
  SlotSettings settings = no_noops();
  settings.steps = Steps::kActs;
  settings.machine.reward_min = 2;  // a step that plays nothing has no reward all the same
  settings.machine.reward_max = 5;
  settings.life_loss = life_loss;
  return settings;
}

TEST_CASE("A request is over only if none of its acts was played") {
  for (const Steps steps : {Steps::kFrames, Steps::kActs}) {
    SlotSettings settings = acts();
    settings.steps = steps;
    Slot slot(cartridge(), settings);
    slot.act({});
    slot.environment().set_ram(test::kOver, 1);
    slot.act({});  // ends the game
    slot.act({});  // plays nothing
    INFO(static_cast<int>(steps));
    CHECK(slot.finished());
    CHECK(slot.outcome().game_over);
    CHECK(slot.outcome().acts == 2);
    CHECK_FALSE(slot.outcome().over);
    CHECK(slot.outcome().reward == 4);
    slot.begin_request();
    CHECK_FALSE(slot.outcome().over);
    slot.act({});
    CHECK(slot.outcome().over);
    CHECK(slot.outcome().acts == 0);
    CHECK(slot.outcome().frames == 0);
    CHECK(slot.outcome().reward == 0);
    CHECK(slot.outcome().finished);
    slot.reset();
    slot.begin_request();
    slot.act({});
    CHECK_FALSE(slot.outcome().over);
    CHECK(slot.outcome().acts == 1);
  }
}

TEST_CASE("Rewards of both players are summed, clamped in each step") {
  constexpr auto kTwo = R"(
title = "Two"
[rule]
step = """
reward = ram[0x90]
reward_b = ram[0x91]
terminal = 0
"""
)";
  SlotSettings settings = acts();
  settings.machine.frame_skip = 1;
  Slot slot({test::counter_image(), test::game(kTwo, "two")}, settings);
  slot.environment().set_ram(test::kScore, 1);
  slot.environment().set_ram(test::kOver, 7);
  slot.act({});
  slot.environment().set_ram(test::kScore, 4);
  slot.act({});
  CHECK(slot.outcome().reward == 2 + 4);
  CHECK(slot.outcome().raw_reward == 1 + 4);
  CHECK(slot.outcome().reward_b == 5 + 5);
  CHECK(slot.outcome().raw_reward_b == 7 + 7);
  CHECK(slot.score() == 1 + 4);
}

// Each counts from the beginning of the game; ALE's limit compares with that.
constexpr auto kThreeLives = R"(
title = "Three"
[rule]
reset = { lives = 3 }
step = """
reward = 0
terminal = 0
lives = 3 - ram[0x92]
"""
)";

TEST_CASE("A lost life ends an act's episode as it was chosen, and the game goes on only where it may") {
  for (const LifeLoss life_loss :
       {LifeLoss::kIgnored, LifeLoss::kReported, LifeLoss::kEnd, LifeLoss::kRestart}) {
    for (const int lives : {2, 0}) {
      Slot slot({test::counter_image(), test::game(kThreeLives, "three")}, acts(life_loss));
      slot.act({});
      slot.environment().set_ram(test::kLives, static_cast<std::uint8_t>(3 - lives));
      slot.begin_request();
      slot.act({});
      INFO(static_cast<int>(life_loss) << ' ' << lives);
      // To ALE's limit, the last life is like others; the other kinds leave it to the game.
      const bool counts = lives > 0 || life_loss == LifeLoss::kRestart;
      CHECK(slot.outcome().terminated == (counts && life_loss != LifeLoss::kIgnored));
      CHECK_FALSE(slot.outcome().truncated);
      CHECK(slot.finished() == (counts && life_loss >= LifeLoss::kEnd));
      const int frames = slot.environment().episode_frame_number();
      slot.act({});
      CHECK((slot.environment().episode_frame_number() == frames) == slot.finished());
      if (!slot.finished()) continue;
      slot.reset();
      CHECK_FALSE(slot.finished());
      CHECK_FALSE(slot.outcome().terminated);
      CHECK((slot.environment().lives() == lives) == (life_loss == LifeLoss::kEnd));
    }
  }
}

TEST_CASE("A life that is lost with the game, or at its limit, does not continue the game") {
  for (const Steps steps : {Steps::kFrames, Steps::kActs}) {
    for (const bool limit : {false, true}) {
      SlotSettings settings = acts(LifeLoss::kEnd);
      settings.steps = steps;
      settings.machine.frame_skip = 1;
      if (limit) settings.machine.max_episode_frames = steps == Steps::kFrames ? 2 : 3;
      Slot slot(cartridge(), settings);
      while (slot.environment().episode_frame_number() < (limit ? 2 : 3)) {
        slot.environment().set_ram(test::kLives, 3);
        slot.act({});
      }
      slot.environment().set_ram(test::kLives, 2);
      if (!limit) slot.environment().set_ram(test::kOver, 1);
      slot.begin_request();
      slot.act({});
      INFO(static_cast<int>(steps) << ' ' << limit);
      CHECK(slot.finished());
      CHECK(slot.outcome().terminated);
      slot.reset();
      CHECK(slot.environment().episode_frame_number() <= 1);  // a frame of FIRE
      CHECK(slot.environment().lives() != 2);
    }
  }
}

TEST_CASE("A step of frames is terminated or truncated, and never both") {
  for (const bool dies : {false, true}) {
    SlotSettings settings = no_noops();
    settings.machine.max_episode_frames = 2;
    settings.fire_at_reset = false;
    settings.machine.frame_skip = 2;
    Slot slot(cartridge(), settings);
    if (dies) slot.environment().set_ram(test::kOver, 1);
    slot.act({});
    CHECK(slot.finished());
    CHECK(slot.outcome().terminated == dies);
    CHECK(slot.outcome().truncated == !dies);
  }
}

TEST_CASE("An episode that reaches its limit of frames is over with that frame") {
  SlotSettings settings = no_noops();
  settings.machine.max_episode_frames = 7;
  settings.fire_at_reset = false;
  Slot slot(cartridge(), settings);
  slot.act({});
  slot.act({});
  CHECK_FALSE(slot.finished());
  slot.begin_request();
  slot.act({});
  CHECK(slot.finished());
  CHECK(slot.outcome().frames == 1);
  CHECK(slot.elapsed() == 7);
}

TEST_CASE(
    "A seed that an episode was ended with holds until a reset, and a restored state has no such seed") {
  SlotSettings settings = no_noops();
  settings.noop_max = 30;
  const auto seed_of = [](const Slot& slot) { return slot.environment().settings().random_seed; };
  Slot slot(cartridge(), settings);
  const Slot::Saved saved = slot.save(true, true);
  slot.end_episode(9U);
  CHECK(slot.finished());
  slot.end_episode(std::nullopt);  // forgets nothing
  slot.reset();
  CHECK(seed_of(slot) == 9);
  const std::uint64_t draws = test::draws(slot.environment());
  slot.reset();
  CHECK(seed_of(slot) == 9);
  CHECK(test::draws(slot.environment()) > draws);  // the second reset did not power on anew
  slot.end_episode(8U);
  slot.reset(7U);
  CHECK(seed_of(slot) == 7);
  slot.reset();
  CHECK(seed_of(slot) == 7);
  slot.end_episode(6U);
  slot.restore(saved);
  CHECK_FALSE(slot.finished());
  slot.reset();
  CHECK(seed_of(slot) == 7);
}

TEST_CASE("A state brings back how far its episode was, and how it ended") {
  SlotSettings settings = no_noops();
  settings.life_loss = LifeLoss::kEnd;
  Slot slot(cartridge(), settings);
  slot.act({});
  const Slot::Saved start = slot.save(true);
  lose_life(slot, 2);
  const Slot::Saved end = slot.save(true);
  const int elapsed = slot.elapsed();
  slot.restore(start);
  CHECK_FALSE(slot.finished());
  CHECK_FALSE(slot.outcome().terminated);
  CHECK(slot.outcome().lives_lost == 0);
  CHECK(slot.elapsed() == 3);
  slot.restore(end);
  CHECK(slot.finished());
  CHECK(slot.outcome().terminated);
  CHECK(slot.elapsed() == elapsed);
  slot.reset();
  CHECK(slot.environment().lives() == 2);  // the game goes on
  CHECK(slot.elapsed() == elapsed);
}

TEST_CASE("A step of frames refuses what it does not know") {
  const auto refuses = [](auto change, const std::string& sentence) {
    SlotSettings settings = no_noops();
    change(settings);
    CHECK_THROWS_WITH(Slot(cartridge(), settings), sentence);
  };
  refuses([](auto& s) { s.machine.frame_skip_max = 5; }, "a step of frames has a fixed number of them");
  SlotSettings fixed = no_noops();
  fixed.machine.frame_skip_max = fixed.machine.frame_skip;
  CHECK_NOTHROW(Slot(cartridge(), fixed));
  refuses([](auto& s) { s.machine.truncate_on_life_loss = true; },
          "a step of frames takes only life_loss for the effect of lost lives");
  refuses([](auto& s) { s.machine.color_averaging = true; },
          "a step of frames has no colour averaging; it takes max_pool");
}

TEST_CASE("A joystick that is turned and tilted gives one of the 18 actions") {
  using std::numbers::pi_v;
  const auto action = [](float radius, float angle, float fire) {
    return act_of(radius, angle, fire, 0.5F).a;
  };
  const std::vector<int> around = {3, 6, 2, 7, 4, 9, 5, 8}, with_fire = {11, 14, 10, 15, 12, 17, 13, 16};
  for (std::size_t eighth = 0; eighth < 8; ++eighth) {
    const float angle = static_cast<float>(eighth) * pi_v<float> / 4;
    CHECK(action(1, angle, 0) == around[eighth]);
    CHECK(action(1, angle, 1) == with_fire[eighth]);
    CHECK(action(0.4F, angle, 1) == 1);
  }
  CHECK(action(0, 0, 0.5F) == 0);
  CHECK(act_of(0.25F, 0, 0, 0.1F).strength_a == 0.25F);
}

}  // namespace
}  // namespace racebeam
