#include "emulator/state/state_hash.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

using test::plain;
using test::steered;

std::uint64_t hash_of(const State& state) {
  StateHash hash;
  hash.add(state);
  return hash.value();
}

State some_state() {
  Environment environment = steered();
  for (int frame = 0; frame < 50; ++frame) environment.act(frame % 18);
  return environment.save()->values.machine;
}

bool all_different(std::vector<std::uint64_t> hashes) {
  std::ranges::sort(hashes);
  return std::ranges::adjacent_find(hashes) == hashes.end();
}

// States that differ in a counter only are the hardest for a hash: three bytes of 536.
TEST_CASE("A million states that differ in a counter have different hashes") {
  State state = some_state();
  std::vector<std::uint64_t> hashes, low_halves;
  for (std::uint32_t count = 0; count < 1'000'000; ++count) {
    std::memcpy(&state.riot.ram[count % 2 == 0 ? 40 : 91], &count, 3);
    hashes.push_back(hash_of(state));
    low_halves.push_back(hashes.back() & 0xFFFFFFFF);
  }
  CHECK(all_different(hashes));
  // With 32 bits, 116 collisions are expected; a good hash has few more.
  std::ranges::sort(low_halves);
  // clang 14 does not compile the subrange that std::ranges::unique returns.
  const auto collisions = low_halves.end() - std::unique(low_halves.begin(), low_halves.end());
  CHECK(collisions < 200);
  CHECK(collisions > 50);
}

TEST_CASE("Each bit of a state changes each bit of its hash about half the time") {
  State state = some_state();
  auto* const bytes = reinterpret_cast<std::uint8_t*>(&state);
  std::array<int, 64> flips{};
  int worst = 64, inputs = 0;
  for (std::size_t bit = 0; bit < 8 * sizeof state; ++bit, ++inputs) {
    const std::uint64_t before = hash_of(state);
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    const std::uint64_t changed = before ^ hash_of(state);
    worst = std::min(worst, std::popcount(changed));
    for (std::size_t out = 0; out < 64; ++out) flips[out] += static_cast<int>(changed >> out & 1);
  }
  CHECK(worst >= 10);  // the least of 4288 draws of 64 coins is about 17
  for (const int count : flips) CHECK(std::abs(count / double(inputs) - 0.5) < 0.05);
}

TEST_CASE("Zeros at the end, and where one part ends, change the hash") {
  const std::vector<std::uint8_t> zeros(64);
  std::vector<std::uint64_t> hashes;
  for (std::size_t size = 0; size <= zeros.size(); ++size) {
    StateHash hash;
    hash.add(std::span(zeros).first(size));
    hashes.push_back(hash.value());
  }
  CHECK(all_different(hashes));
}

TEST_CASE("The same state reached by different ways is the same") {
  Environment one = steered(), other = steered();
  CHECK(one.same_state(other));
  CHECK(one.state_hash() == other.state_hash());
  one.act(1);
  CHECK_FALSE(one.same_state(other));
  CHECK(one.state_hash() != other.state_hash());

  const auto saved = one.save();
  for (int frame = 0; frame < 10; ++frame) other.act(frame);
  CHECK_FALSE(one.same_state(other));
  other.restore(*saved);
  CHECK(one.same_state(other));
  CHECK(one.state_hash() == other.state_hash());
  CHECK(one.state_hash() == saved->state_hash());
  CHECK(saved->same_state(*other.save(true)));
}

TEST_CASE("One byte of RAM, a mode or a difficulty makes another state") {
  const auto differs = [](auto change) {
    Environment one = steered(), other = steered();
    change(other);
    return !one.same_state(other) && one.state_hash() != other.state_hash();
  };
  CHECK(differs([](Environment& e) { e.set_ram(77, static_cast<std::uint8_t>(e.ram()[77] + 1)); }));
  CHECK(differs([](Environment& e) { e.set_mode(3); }));
  CHECK(differs([](Environment& e) { e.set_difficulty(1); }));
}

TEST_CASE("How long the way was does not count") {
  Environment environment = steered();
  const auto start = environment.save();
  environment.act(0);
  const auto after = environment.save();
  environment.restore(*start);
  CHECK_FALSE(start->same_state(*after));
  auto later = *start;
  later.values.play.frames += 1000;
  later.values.play.episode_frames += 1000;
  later.values.play.rewards = {5, 0};
  later.values.audio[3] = 9;
  CHECK(start->same_state(later));
  CHECK(start->state_hash() == later.state_hash());
}

}  // namespace
}  // namespace racebeam
