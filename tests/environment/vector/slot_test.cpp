// How the steps and episodes of a slot go.
#include "environment/vector/slot.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "games/rom_image.hpp"
#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

Cartridge cartridge() { return {test::counter_image(), test::game()}; }

SlotSettings no_noops() {
  SlotSettings settings;
  settings.machine.random_seed = 4;
  settings.machine.frame_skip = 3;
  settings.noop_max = 0;
  return settings;
}

// What is pressed in each frame until the episode has begun: '-' nothing, 'F' FIRE, 'U' up.
std::string pressed_at_reset(Slot& slot) {
  std::string pressed;
  slot.environment().watch([&] {
    const bool fire = test::at(slot.environment(), 0x83) < 0x80,
               up = (test::at(slot.environment(), 0x81) & 0x10) == 0;
    pressed += fire ? 'F' : up ? 'U' : '-';
  });
  slot.reset();
  slot.environment().watch({});
  return pressed;
}

void lose_life(Slot& slot, int remaining) {
  slot.environment().set_ram(test::kLives, 3);
  slot.act({});
  slot.environment().set_ram(test::kLives, static_cast<std::uint8_t>(remaining));
  slot.begin_request();
  slot.act({});
}

TEST_CASE("An episode begins with FIRE and no-ops, in the order that was chosen") {
  // RAM shows what was pressed one frame before: the first frame after a reset does not count.
  const auto pressed = [](ResetOrder order, int noop_max, bool fire = true) {
    SlotSettings settings = no_noops();
    settings.reset_order = order;
    settings.noop_max = noop_max;
    settings.fire_at_reset = fire;
    Slot slot(cartridge(), settings);
    return pressed_at_reset(slot);
  };
  CHECK(pressed(ResetOrder::kFireNoops, 0) == "F");
  CHECK(pressed(ResetOrder::kFireNoops, 0, false).empty());
  CHECK(pressed(ResetOrder::kNoopsFire, 0) == "F");
  CHECK(pressed(ResetOrder::kNoopsFire, 0, false) == "-");
  CHECK(pressed(ResetOrder::kBaselines, 0) == "FFFUUU");
  CHECK(pressed(ResetOrder::kBaselines, 1) == "-FFFUUU");
  const std::string fire_first = pressed(ResetOrder::kFireNoops, 30),
                    noops_first = pressed(ResetOrder::kNoopsFire, 30);
  REQUIRE(fire_first.size() > 2);
  const std::string noops(fire_first.size() - 1, '-');
  CHECK(fire_first == std::string("F").append(noops));
  CHECK(noops_first == std::string("-").append(noops).append("F"));  // the same draw
  CHECK(pressed(ResetOrder::kBaselines, 30) == std::string("--").append(noops).append("FFFUUU"));
}

TEST_CASE("A lost life does to the episode what was chosen") {
  const auto after = [](LifeLoss life_loss) {
    SlotSettings settings = no_noops();
    settings.life_loss = life_loss;
    auto slot = std::make_unique<Slot>(cartridge(), settings);
    lose_life(*slot, 2);
    return slot;
  };
  for (const LifeLoss life_loss :
       {LifeLoss::kIgnored, LifeLoss::kReported, LifeLoss::kEnds, LifeLoss::kResets}) {
    const auto slot = after(life_loss);
    INFO(static_cast<int>(life_loss));
    CHECK(slot->outcome().terminated == (life_loss != LifeLoss::kIgnored));
    CHECK(slot->finished() == (life_loss >= LifeLoss::kEnds));
    CHECK(slot->outcome().lives_lost == 1);
    CHECK(slot->outcome().frames == (slot->finished() ? 1 : 3));
    CHECK_FALSE(slot->outcome().game_over);
    const int frames = slot->environment().episode_frame_number();
    slot->reset();
    CHECK_FALSE(slot->finished());
    CHECK((slot->environment().episode_frame_number() == frames + 1) == (life_loss == LifeLoss::kEnds));
    CHECK((slot->environment().lives() == 2) == (life_loss == LifeLoss::kEnds));
  }
}

TEST_CASE(
    "An episode that goes on with the next life ends with the game's limit of frames, and a seed begins a "
    "new game") {
  SlotSettings settings = no_noops();
  settings.life_loss = LifeLoss::kEnds;
  settings.machine.max_episode_frames = 6;
  Slot slot(cartridge(), settings);
  lose_life(slot, 2);  // 4 frames
  slot.reset();
  slot.act({});
  CHECK(slot.outcome().truncated);
  CHECK(slot.finished());
  slot.reset();
  CHECK(slot.environment().episode_frame_number() == 1);
  lose_life(slot, 1);
  slot.reset(9U);
  CHECK(slot.environment().frame_number() == 1);
}

TEST_CASE("A step that loses a life is played to its end where the model has it so") {
  for (const ResetOrder order : {ResetOrder::kFireNoops, ResetOrder::kNoopsFire, ResetOrder::kBaselines}) {
    SlotSettings settings = no_noops();
    settings.reset_order = order;
    settings.life_loss = LifeLoss::kEnds;
    Slot slot(cartridge(), settings);
    lose_life(slot, 2);
    INFO(static_cast<int>(order));
    CHECK(slot.outcome().frames == (order == ResetOrder::kFireNoops ? 1 : 3));
    CHECK(slot.outcome().terminated);
    CHECK(slot.finished());
  }
}

TEST_CASE("The last life is the game's own matter") {
  SlotSettings settings = no_noops();
  settings.life_loss = LifeLoss::kEnds;
  Slot slot(cartridge(), settings);
  lose_life(slot, 0);
  CHECK_FALSE(slot.finished());
}

TEST_CASE("The next life begins as the model has it") {
  const auto pressed = [](ResetOrder order) {
    SlotSettings settings = no_noops();
    settings.reset_order = order;
    settings.life_loss = LifeLoss::kEnds;
    Slot slot(cartridge(), settings);
    lose_life(slot, 2);
    return pressed_at_reset(slot);
  };
  CHECK(pressed(ResetOrder::kFireNoops) == "F");
  CHECK(pressed(ResetOrder::kNoopsFire) == "F");
  CHECK(pressed(ResetOrder::kBaselines) == "---FFFUUU");
}

TEST_CASE("A stack begins with zeros or with the first screen, and may live on with the game") {
  constexpr std::size_t kScreen = 84 * 84;
  const auto oldest = [](const Slot& slot) {
    const auto bytes = slot.stack()->bytes();
    return std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + kScreen);
  };
  const auto newest = [](const Slot& slot) {
    const auto bytes = slot.stack()->bytes();
    return std::vector<std::uint8_t>(bytes.end() - kScreen, bytes.end());
  };
  const std::vector<std::uint8_t> zeros(kScreen);
  for (const StackStart start : {StackStart::kZeros, StackStart::kRepeats}) {
    SlotSettings settings = no_noops();
    settings.stack_start = start;
    settings.life_loss = LifeLoss::kEnds;
    Slot slot(cartridge(), settings);
    slot.set_stack(StackSettings{.depth = 2});
    slot.act({});
    slot.reset();
    CHECK(oldest(slot) == (start == StackStart::kZeros ? zeros : newest(slot)));
    lose_life(slot, 2);
    const auto last = newest(slot);
    slot.reset();
    CHECK(oldest(slot) == (start == StackStart::kZeros ? zeros : last));
    CHECK(last != zeros);
  }
}

// The game whose pictures move.
Cartridge beamfall() { return {load_image("builtin:beamfall"), find_game("beamfall")}; }

constexpr Act kRight{.a = 3};

// What an agent sees after so many frames of the right button: the last one, or the brighter of the last two.
std::vector<std::uint8_t> seen_after(SlotSettings settings, int frames, bool pooled) {
  settings.machine.frame_skip = 1;
  settings.machine.max_episode_frames = 0;
  Slot slot(beamfall(), settings);
  for (int frame = 0; frame < frames; ++frame) slot.act(kRight);
  ScreenStack stack({.depth = 1}, slot.environment());
  stack.look(slot.environment(), pooled);
  stack.push();
  return stack.bytes();
}

TEST_CASE("The last screen of an episode is the last frame, or of the step before where a step is short") {
  for (const ResetOrder order : {ResetOrder::kNoopsFire, ResetOrder::kBaselines}) {
    SlotSettings settings = no_noops();
    settings.machine.frame_skip = 4;
    settings.reset_order = order;
    settings.fire_at_reset = false;
    const auto last_of = [&settings](int frames) {
      settings.machine.max_episode_frames = frames;
      Slot slot(beamfall(), settings);
      slot.set_stack(StackSettings{.depth = 1});
      while (!slot.finished()) slot.act(kRight);
      return slot.stack()->bytes();
    };
    INFO(static_cast<int>(order));
    REQUIRE(seen_after(settings, 44, true) != seen_after(settings, 44, false));
    REQUIRE(seen_after(settings, 40, true) != seen_after(settings, 44, true));
    CHECK(last_of(44) == seen_after(settings, 44, true));
    CHECK(last_of(43) == seen_after(settings, 43, false));
    CHECK(last_of(42) == seen_after(settings, 40, true));
    CHECK(last_of(41) == seen_after(settings, 40, true));
  }
}

TEST_CASE("The first screen of an episode is pooled where whole steps of FIRE begin it") {
  SlotSettings settings = no_noops();
  settings.machine.frame_skip = 4;
  settings.reset_order = ResetOrder::kBaselines;
  for (const bool fire : {true, false}) {
    settings.fire_at_reset = fire;
    Slot slot(beamfall(), settings);
    CHECK(slot.blends() == fire);
  }
}

TEST_CASE("A reset with a seed keeps the difficulty, be it one that the game does not offer") {
  constexpr auto kHard = R"(
title = "Hard"
difficulties = [3]
[rule]
step = "score = 0; terminal = 0"
)";
  Slot slot({test::counter_image(), test::game(kHard, "hard")}, no_noops());
  CHECK(slot.environment().difficulty() == 0);
  slot.reset(7);
  CHECK(slot.environment().difficulty() == 0);
  SlotSettings settings = no_noops();
  settings.difficulty = 3;
  Slot chosen({test::counter_image(), test::game(kHard, "hard")}, settings);
  chosen.reset(7);
  CHECK(chosen.environment().difficulty() == 3);
}

TEST_CASE("A slot tells which acts begin an episode") {
  SlotSettings settings = no_noops();
  settings.noop_max = 30;
  Slot slot(cartridge(), settings);
  int beginning = 0, played = 0;
  slot.environment().watch([&] { ++(slot.begins() ? beginning : played); });
  for (const auto seed : {std::optional<std::uint32_t>(), std::optional(3U)}) slot.reset(seed);
  CHECK(beginning > 0);
  CHECK(played == 0);
  slot.act({});
  CHECK(played == slot.outcome().frames);
}

TEST_CASE("A reset that fails leaves a slot as it was") {
  struct Impatient final : Pace {
    void frame() override {
      if (++count > most) throw std::runtime_error("too long");
    }
    std::int64_t frames() const override { return count; }
    std::int64_t count = 0, most = 1'000'000;
  } pace;
  SlotSettings settings = no_noops();
  settings.noop_max = 30;
  settings.machine.copy_resets = false;
  Slot slot(cartridge(), settings, &pace);
  CHECK(slot.reset_frames() > 60);
  slot.act({});
  const auto before = slot.environment().save(true);
  for (const auto seed : {std::optional<std::uint32_t>(), std::optional(3U)}) {
    pace.most = pace.count + 50;
    CHECK_THROWS_WITH(slot.reset(seed), "too long");
    CHECK(slot.environment().same_state(slot.environment()));
    CHECK(slot.environment().save(true)->same_state(*before));
    CHECK(slot.environment().save(true)->random == before->random);
    CHECK(slot.environment().episode_frame_number() > 3);
    CHECK(slot.environment().settings().random_seed == settings.machine.random_seed);
  }
}

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
       {LifeLoss::kIgnored, LifeLoss::kReported, LifeLoss::kEnds, LifeLoss::kResets}) {
    for (const int lives : {2, 0}) {
      Slot slot({test::counter_image(), test::game(kThreeLives, "three")}, acts(life_loss));
      slot.act({});
      slot.environment().set_ram(test::kLives, static_cast<std::uint8_t>(3 - lives));
      slot.begin_request();
      slot.act({});
      INFO(static_cast<int>(life_loss) << ' ' << lives);
      // To ALE's limit, the last life is like others; the other kinds leave it to the game.
      const bool counts = lives > 0 || life_loss == LifeLoss::kResets;
      CHECK(slot.outcome().terminated == (counts && life_loss != LifeLoss::kIgnored));
      CHECK_FALSE(slot.outcome().truncated);
      CHECK(slot.finished() == (counts && life_loss >= LifeLoss::kEnds));
      const int frames = slot.environment().episode_frame_number();
      slot.act({});
      CHECK((slot.environment().episode_frame_number() == frames) == slot.finished());
      if (!slot.finished()) continue;
      slot.reset();
      CHECK_FALSE(slot.finished());
      CHECK_FALSE(slot.outcome().terminated);
      CHECK((slot.environment().lives() == lives) == (life_loss == LifeLoss::kEnds));
    }
  }
}

TEST_CASE("A life that is lost with the game, or at its limit, does not continue the game") {
  for (const Steps steps : {Steps::kFrames, Steps::kActs}) {
    for (const bool limit : {false, true}) {
      SlotSettings settings = acts(LifeLoss::kEnds);
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
  settings.life_loss = LifeLoss::kEnds;
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
