// How the steps and episodes of a slot go.
#include "environment/vector/slot.hpp"

#include <catch2/catch.hpp>

#include "tests/environment/steered.hpp"
#include "tests/environment/vector/slot_steps.hpp"

namespace racebeam {
namespace {

using test::cartridge, test::lose_life, test::no_noops;

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
       {LifeLoss::kIgnored, LifeLoss::kReported, LifeLoss::kEnd, LifeLoss::kRestart}) {
    const auto slot = after(life_loss);
    INFO(static_cast<int>(life_loss));
    CHECK(slot->outcome().terminated == (life_loss != LifeLoss::kIgnored));
    CHECK(slot->finished() == (life_loss >= LifeLoss::kEnd));
    CHECK(slot->outcome().lives_lost == 1);
    CHECK(slot->outcome().frames == (slot->finished() ? 1 : 3));
    CHECK_FALSE(slot->outcome().game_over);
    const int frames = slot->environment().episode_frame_number();
    slot->reset();
    CHECK_FALSE(slot->finished());
    CHECK((slot->environment().episode_frame_number() == frames + 1) == (life_loss == LifeLoss::kEnd));
    CHECK((slot->environment().lives() == 2) == (life_loss == LifeLoss::kEnd));
  }
}

TEST_CASE(
    "An episode that goes on with the next life ends with the game's limit of frames, and a seed begins a "
    "new game") {
  SlotSettings settings = no_noops();
  settings.life_loss = LifeLoss::kEnd;
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
    settings.life_loss = LifeLoss::kEnd;
    Slot slot(cartridge(), settings);
    lose_life(slot, 2);
    INFO(static_cast<int>(order));
    CHECK(slot.outcome().frames == (order == ResetOrder::kFireNoops ? 1 : 3));
    CHECK(slot.outcome().terminated);
    CHECK(slot.finished());
  }
}

TEST_CASE("The last life is the game's own matter, and the one before it is not") {
  for (const int remaining : {0, 1}) {
    SlotSettings settings = no_noops();
    settings.life_loss = LifeLoss::kEnd;
    Slot slot(cartridge(), settings);
    lose_life(slot, remaining);
    INFO(remaining);
    CHECK(slot.finished() == (remaining == 1));
    CHECK(slot.outcome().terminated == (remaining == 1));
  }
}

TEST_CASE("The next life begins as the model has it") {
  const auto pressed = [](ResetOrder order) {
    SlotSettings settings = no_noops();
    settings.reset_order = order;
    settings.life_loss = LifeLoss::kEnd;
    Slot slot(cartridge(), settings);
    lose_life(slot, 2);
    return pressed_at_reset(slot);
  };
  CHECK(pressed(ResetOrder::kFireNoops) == "F");
  CHECK(pressed(ResetOrder::kNoopsFire) == "F");
  CHECK(pressed(ResetOrder::kBaselines) == "---FFFUUU");
}

bool repeats_one_screen(const std::vector<std::uint8_t>& stack, std::size_t screen) {
  return std::equal(stack.begin() + static_cast<std::ptrdiff_t>(screen), stack.end(), stack.begin());
}

TEST_CASE("The next life continues the score, the frames and the stack, unless the game ends as it begins") {
  struct Row {
    ResetOrder order;
    bool fire, ends;  // the game, with the first frame that is run for the next life
  };
  const Row rows[] = {
      {ResetOrder::kFireNoops, true, false},  {ResetOrder::kFireNoops, true, true},
      {ResetOrder::kFireNoops, false, false},  // no frame is run
      {ResetOrder::kNoopsFire, true, false},  {ResetOrder::kNoopsFire, true, true},
      {ResetOrder::kNoopsFire, false, false}, {ResetOrder::kNoopsFire, false, true},
      {ResetOrder::kBaselines, true, false},  {ResetOrder::kBaselines, true, true},
  };
  for (const Row& row : rows) {
    INFO(static_cast<int>(row.order) << ' ' << row.fire << ' ' << row.ends);
    SlotSettings settings = no_noops();
    settings.reset_order = row.order;
    settings.fire_at_reset = row.fire;
    settings.life_loss = LifeLoss::kEnd;
    settings.stack_start = StackStart::kRepeats;
    Slot slot(cartridge(), settings);
    slot.set_stack(StackSettings{.depth = 4});
    slot.act({});
    slot.environment().set_ram(test::kScore, 5);
    lose_life(slot, 2);
    const int elapsed = slot.elapsed();
    if (row.ends) slot.environment().set_ram(test::kOver, 1);
    slot.reset();
    CHECK_FALSE(slot.finished());
    CHECK(slot.environment().lives() == (row.ends ? 0 : 2));
    CHECK(slot.score() == (row.ends ? 0 : 5));
    CHECK(slot.elapsed() == (row.ends ? 0 : elapsed));
    CHECK(repeats_one_screen(slot.stack()->bytes(), std::size_t{84} * 84) == row.ends);
  }
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
    settings.life_loss = LifeLoss::kEnd;
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

// What an agent sees after this many frames of the right button: the last one, or the brighter of the last
// two.
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

TEST_CASE(
    "The sound of a request has the frames of its acts, but not those that begin an episode or a life") {
  for (const ResetOrder order : {ResetOrder::kFireNoops, ResetOrder::kNoopsFire, ResetOrder::kBaselines}) {
    SlotSettings settings = no_noops();
    settings.machine.sound = true;
    settings.all_audio = true;
    settings.noop_max = 30;
    settings.reset_order = order;
    settings.life_loss = LifeLoss::kEnd;
    Slot slot(cartridge(), settings);
    INFO(static_cast<int>(order));
    CHECK(slot.environment().all_audio().empty());
    lose_life(slot, 2);
    CHECK(slot.environment().all_audio().size() ==
          static_cast<std::size_t>(slot.outcome().frames) * kAudioSize);
    slot.reset();  // the next life
    CHECK(slot.environment().lives() == 2);
    CHECK(slot.environment().all_audio().empty());
    slot.reset();  // the next game
    CHECK(slot.environment().lives() == 0);
    CHECK(slot.environment().all_audio().empty());
  }
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
  Slot slot(cartridge(), settings, &pace), undisturbed(cartridge(), settings);
  CHECK(slot.reset_frames() > 60);
  slot.act({});
  undisturbed.act({});
  const auto before = slot.environment().save(true);
  for (const auto seed : {std::optional<std::uint32_t>(), std::optional(3U)}) {
    for (const int frames : {50, 72}) {  // while the console starts, and among the no-ops, which draw
      pace.most = pace.count + frames;
      CHECK_THROWS_WITH(slot.reset(seed), "too long");
      CHECK(slot.environment().save(true)->same_state(*before));
      CHECK(*slot.environment().save(true)->random == *before->random);
      CHECK(slot.environment().episode_frame_number() > 3);
      CHECK(slot.environment().settings().random_seed == settings.machine.random_seed);
    }
  }
  pace.most = 1'000'000;
  slot.reset();
  undisturbed.reset();
  CHECK(slot.environment().same_state(undisturbed.environment()));
  CHECK(slot.environment().episode_frame_number() == undisturbed.environment().episode_frame_number());
}

}  // namespace
}  // namespace racebeam
