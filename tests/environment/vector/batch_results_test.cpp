// What a slot shows, in the arrays of a batch.
#include "environment/vector/batch_results.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/environment/steered.hpp"
#include "tests/environment/vector/slot_steps.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Numbers = std::vector<std::int32_t>;
using test::no_noops;

constexpr std::size_t kPlaces = 3, kPlace = 1;  // of the arrays, and the one that is written
constexpr std::int32_t kOld = 77;               // what was there before

constexpr int kOverByte = 0x13;
constexpr auto kTwo = R"(
title = "Two"
[rule]
step = """
reward = ram[0x90]
reward_b = ram[0x91]
lives = ram[0x92]
terminal = ram[0x93] != 0
"""
)";

SlotSettings with_sound() {
  SlotSettings settings = no_noops();
  settings.machine.sound = true;
  settings.machine.reward_min = 5;
  settings.machine.reward_max = 10;
  settings.life_loss = LifeLoss::kReported;
  return settings;
}

// A slot in its second episode, after a request of two acts in which a life was lost.
std::unique_ptr<Slot> played(const SlotSettings& settings) {
  auto slot = std::make_unique<Slot>(Cartridge{test::counter_image(), test::game(kTwo, "two")}, settings);
  slot->set_stack(StackSettings{.depth = 2});
  slot->act({});
  slot->reset();
  Environment& machine = slot->environment();
  machine.set_ram(test::kLives, 3);
  slot->act({});
  slot->begin_request();
  machine.set_ram(test::kScore, 4);  // in each of three frames
  machine.set_ram(0x11, 1);
  machine.set_ram(test::kLives, 2);
  slot->act({});
  slot->act({});
  return slot;
}

ResultLayout layout_of(const StackSettings& stack, int height) {
  ResultLayout layout(stack, true, true);
  layout.set_height(height);
  return layout;
}

template <typename T>
std::vector<T> place(const std::vector<T>& array, std::size_t number = kPlace) {
  const std::size_t size = array.size() / kPlaces;
  const auto begin = array.begin() + static_cast<std::ptrdiff_t>(number * size);
  return {begin, begin + static_cast<std::ptrdiff_t>(size)};
}

// Fills everything with what was there before.
void spoil(BatchResults& results) {
  for (Bytes* bytes :
       {&results.observations, &results.final_observations, &results.final_ram, &results.screens,
        &results.ram, &results.terminated, &results.truncated, &results.finished, &results.game_over})
    std::ranges::fill(*bytes, static_cast<std::uint8_t>(kOld));
  for (Numbers* numbers :
       {&results.final_lives, &results.final_frames, &results.final_episode_frames, &results.rewards,
        &results.rewards_b, &results.raw_rewards, &results.raw_rewards_b, &results.lives, &results.frames,
        &results.episode_frames, &results.numbers, &results.elapsed, &results.acts, &results.lives_lost})
    std::ranges::fill(*numbers, kOld);
}

TEST_CASE("Each number of a slot has its array, and only its place is written") {
  const auto slot = played(with_sound());
  const Environment& machine = slot->environment();
  const ResultLayout layout = layout_of({.depth = 2}, machine.height());
  BatchResults results = layout.make_results(kPlaces);
  spoil(results);
  layout.write(*slot, 9, kPlace, results.arrays());
  const auto only = [](std::int32_t value) { return Numbers{kOld, value, kOld}; };
  CHECK(results.rewards == only(10 + 10));
  CHECK(results.raw_rewards == only(12 + 12));
  CHECK(results.rewards_b == only(5 + 5));
  CHECK(results.raw_rewards_b == only(3 + 3));
  CHECK(results.lives == only(2));
  CHECK(results.numbers == only(9));
  CHECK(results.elapsed == only(9));
  CHECK(results.episode_frames == only(9 + 1));  // with FIRE
  CHECK(results.frames == only(machine.frame_number()));
  CHECK(machine.frame_number() == 1 + 3 + 1 + 9);
  CHECK(results.acts == only(2));
  CHECK(results.lives_lost == only(1));
  CHECK(place(results.ram) == Bytes(machine.ram().begin(), machine.ram().end()));
  CHECK(place(results.screens) == Bytes(machine.screen().begin(), machine.screen().end()));
  CHECK(place(results.observations) == slot->stack()->bytes());
  for (const std::size_t other : {0, 2})
    for (const Bytes* bytes : {&results.ram, &results.screens, &results.observations})
      CHECK(std::ranges::all_of(place(*bytes, other), [](std::uint8_t byte) { return byte == kOld; }));
  for (const Bytes* bytes : {&results.final_observations, &results.final_ram})
    CHECK(std::ranges::all_of(*bytes, [](std::uint8_t byte) { return byte == kOld; }));
  CHECK(results.final_lives == Numbers(kPlaces, kOld));
}

TEST_CASE("Each flag of a slot has its array") {
  struct Row {
    int limit;
    bool ends;
    std::array<std::uint8_t, 4> flags;  // terminated, truncated, finished, game over
  };
  const Row rows[] = {{0, false, {0, 0, 0, 0}}, {12, false, {0, 1, 1, 0}}, {0, true, {1, 0, 1, 1}}};
  for (const auto& [limit, ends, flags] : rows) {
    SlotSettings settings = with_sound();
    settings.machine.max_episode_frames = limit;
    const auto slot = played(settings);
    slot->environment().set_ram(kOverByte, ends ? 1 : 0);
    slot->act({});
    const ResultLayout layout = layout_of({.depth = 2}, slot->environment().height());
    BatchResults results = layout.make_results(kPlaces);
    layout.write(*slot, 0, kPlace, results.arrays());
    INFO(limit << ' ' << ends);
    CHECK(std::array{results.terminated[kPlace], results.truncated[kPlace], results.finished[kPlace],
                     results.game_over[kPlace]} == flags);
  }
}

TEST_CASE("The end of an episode is the same at once and when it was kept") {
  const auto slot = played(with_sound());
  const Environment& machine = slot->environment();
  const ResultLayout layout = layout_of({.depth = 2}, machine.height());
  BatchResults at_once = layout.make_results(kPlaces), later = layout.make_results(kPlaces);
  spoil(at_once), spoil(later);
  Bytes sound(kPlaces * kAudioSize), later_sound(sound.size());
  BatchArrays arrays = at_once.arrays(), later_arrays = later.arrays();
  arrays.final_audio = sound, later_arrays.final_audio = later_sound;
  layout.write_final(*slot, kPlace, arrays);
  FinalResult kept;
  kept.keep(layout, *slot);
  kept.write(kPlace, later_arrays);
  for (const BatchResults* results : {&at_once, &later}) {
    CHECK(results->final_lives == Numbers{kOld, 2, kOld});
    CHECK(results->final_frames == Numbers{kOld, machine.frame_number(), kOld});
    CHECK(results->final_episode_frames == Numbers{kOld, 10, kOld});
    CHECK(place(results->final_ram) == Bytes(machine.ram().begin(), machine.ram().end()));
    CHECK(place(results->final_observations) == slot->stack()->bytes());
    CHECK(results->lives == Numbers(kPlaces, kOld));
  }
  CHECK(at_once.final_observations == later.final_observations);
  CHECK(at_once.final_ram == later.final_ram);
  CHECK(place(sound) == Bytes(machine.audio().begin(), machine.audio().end()));
  CHECK(later_sound == sound);
}

TEST_CASE("A lower machine leaves zeros below its screens") {
  const auto slot = played(with_sound());
  const Environment& machine = slot->environment();
  const std::size_t own = std::size_t{kScreenWidth} * static_cast<std::size_t>(machine.height()),
                    tall = own + std::size_t{2} * kScreenWidth;
  slot->set_stack(StackSettings{.depth = 2, .width = 0, .height = 0});
  const ResultLayout layout = layout_of({.depth = 2, .width = 0, .height = 0}, machine.height() + 2);
  CHECK(layout.height() == machine.height() + 2);
  CHECK(layout.observation_size() == 2 * tall);
  BatchResults results = layout.make_results(kPlaces);
  spoil(results);
  layout.write(*slot, 0, kPlace, results.arrays());
  const auto zeros_from = [](const Bytes& bytes, std::size_t begin, std::size_t end) {
    return std::all_of(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                       bytes.begin() + static_cast<std::ptrdiff_t>(end),
                       [](std::uint8_t byte) { return byte == 0; });
  };
  const Bytes screen = place(results.screens), stack = place(results.observations),
              seen = slot->stack()->bytes();
  CHECK(std::ranges::equal(std::span(screen).first(own), machine.screen()));
  CHECK(zeros_from(screen, own, tall));
  for (const std::size_t plane : {0, 1}) {
    CHECK(std::ranges::equal(std::span(stack).subspan(plane * tall, own),
                             std::span(seen).subspan(plane * own, own)));
    CHECK(zeros_from(stack, plane * tall + own, (plane + 1) * tall));
  }
}

TEST_CASE("The sound of a step is followed by silence, and that of a frame is the last") {
  for (const bool all : {false, true}) {
    SlotSettings settings = with_sound();
    settings.all_audio = all;
    settings.machine.max_episode_frames = 8;  // the third act of the second episode has two frames
    auto slot = std::make_unique<Slot>(test::cartridge(), settings);
    for (int act = 0; act < 3; ++act) {
      slot->begin_request();
      slot->act({});
    }
    REQUIRE(slot->outcome().frames == 2);
    const std::size_t size = audio_size(settings);
    CHECK(size == (all ? 3 * kAudioSize : kAudioSize));
    Bytes sound(kPlaces * size, static_cast<std::uint8_t>(kOld));
    BatchArrays arrays;
    arrays.audio = sound;
    layout_of({}, slot->environment().height()).write(*slot, 0, kPlace, arrays);
    const auto samples =
        all ? slot->environment().all_audio() : std::span<const std::uint8_t>(slot->environment().audio());
    const Bytes own = place(sound);
    CHECK(std::ranges::equal(std::span(own).first(samples.size()), samples));
    CHECK(std::all_of(own.begin() + static_cast<std::ptrdiff_t>(samples.size()), own.end(),
                      [](std::uint8_t byte) { return byte == 128; }));
    CHECK(samples.size() == (all ? 2 * kAudioSize : kAudioSize));
  }
}

}  // namespace
}  // namespace racebeam
