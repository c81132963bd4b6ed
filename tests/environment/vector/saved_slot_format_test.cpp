// States of slots as bytes: what comes back, and what is refused.
#include "environment/vector/saved_slot_format.hpp"

#include <zlib.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "environment/saved/saved_state_format.hpp"
#include "system/invalid_input.hpp"
#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kHeader = 20, kElapsed = kHeader + 8, kDepth = kElapsed + 8, kWidth = kDepth + 4,
                      kMachineSize = kDepth + 12, kFlags = kMachineSize + 4;

struct Played {
  Played() : slot({test::counter_image(), test::game()}, settings()) {
    slot.set_stack(StackSettings{.depth = 3});
    for (int step = 0; step < 7; ++step) slot.act({.a = step});
  }
  static SlotSettings settings() {
    SlotSettings settings;
    settings.machine.random_seed = 8;
    settings.machine.sticky = 0.25F;
    settings.machine.max_episode_frames = 60;
    return settings;
  }
  Bytes bytes() const { return to_bytes(slot.save(true, true), slot.environment()); }
  Slot slot;
};

// What the slot shows in this many steps, with a reset where an episode ends.
Bytes play(Slot& slot, int steps) {
  Bytes bytes;
  for (int step = 0; step < steps; ++step) {
    slot.begin_request();
    slot.finished() ? slot.reset() : slot.act({.a = step % 18});
    const Bytes stack = slot.stack()->bytes();
    bytes.insert(bytes.end(), stack.begin(), stack.end());
    const auto ram = slot.environment().ram();
    bytes.insert(bytes.end(), ram.begin(), ram.end());
    bytes.push_back(slot.finished());
  }
  return bytes;
}

void seal(Bytes& bytes) {
  const auto crc =
      static_cast<std::uint32_t>(crc32(0, bytes.data() + kHeader, static_cast<uInt>(bytes.size() - kHeader)));
  std::memcpy(bytes.data() + 16, &crc, sizeof crc);
}

template <class Value>
Bytes with(Bytes bytes, std::size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  seal(bytes);
  return bytes;
}

TEST_CASE("A slot that takes another's bytes plays on as that one, through the ends of episodes") {
  Played one;
  const Bytes bytes = one.bytes();
  SlotSettings settings = Played::settings();
  settings.machine.random_seed = 77;
  Slot other({test::counter_image(), test::game()}, settings);
  other.set_stack(StackSettings{.depth = 3});
  other.restore(saved_slot(bytes, other.environment()));
  CHECK(to_bytes(other.save(true, true), other.environment()) == bytes);
  CHECK(play(other, 100) == play(one.slot, 100));
}

TEST_CASE("A slot's bytes may be without a stack and without generators") {
  Slot slot({test::counter_image(), test::game()}, Played::settings());
  const Bytes bytes = to_bytes(slot.save(false), slot.environment());
  const Slot::Saved saved = saved_slot(bytes, slot.environment());
  CHECK(saved.stack.empty());
  CHECK(saved.noops == nullptr);
  CHECK_FALSE(saved.with_random);
}

TEST_CASE("A slot's bytes that were cut or altered are refused") {
  const Played played;
  const Bytes whole = played.bytes();
  const auto refuses = [&](const Bytes& bytes, const std::string& sentence) {
    CHECK_THROWS_WITH(saved_slot(bytes, played.slot.environment()), Catch::Contains(sentence));
  };
  for (std::size_t size = 0; size < whole.size(); size += size < 100 ? 1 : 997)
    refuses(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(size)),
            size < 60 ? "are not a state of a vector environment" : "it was truncated, or bytes were added");
  for (std::size_t at = 0; at < whole.size(); at += at < 100 ? 1 : 997) {
    Bytes altered = whole;
    altered[at] ^= 0x40;
    CHECK_THROWS_AS(saved_slot(altered, played.slot.environment()), InvalidInput);
  }
  refuses(with(whole, 8, 99), "another version of racebeam (format 99; this one reads format 1)");
  refuses(with(whole, kElapsed, -1), "the number of frames played is -1; it must be from 0 to 1073741824");
  refuses(with(whole, kDepth, 4), "the state's size contradicts its header");
  refuses(with(whole, kDepth, 1 << 30), "the number of screens in the stack is 1073741824");
  refuses(with(whole, kWidth, -1), "the width of a screen in the stack is -1");
  refuses(with(whole, kMachineSize, -1), "the state's size contradicts its header");
  for (std::size_t flag = 0; flag < 8; ++flag)
    refuses(with(whole, kFlags + flag, std::uint8_t{2}), "is 2; it must be");
}

TEST_CASE("A slot's bytes with a correct checksum are refused, or can be played") {
  Played played;
  const Bytes whole = played.bytes();
  std::mt19937 random(5);
  int restored = 0;
  for (int round = 0; round < 400; ++round) {
    Bytes altered = whole;
    const std::size_t some = round % 2 == 0 ? 60 : altered.size();  // half of them in the slot's own part
    altered[kHeader + random() % (some - kHeader)] = static_cast<std::uint8_t>(random());
    seal(altered);
    try {
      const Slot::Saved saved = saved_slot(altered, played.slot.environment());
      played.slot.check_stack(saved);
      played.slot.restore(saved);
      ++restored;
    } catch (const InvalidInput&) {
      continue;
    }
    play(played.slot, 3);
  }
  CHECK(restored > 20);
}

TEST_CASE("A stack of other screens is refused where it is asked for") {
  Played played;
  const auto of = [&](const std::optional<StackSettings>& stack) {
    Slot slot({test::counter_image(), test::game()}, Played::settings());
    slot.set_stack(stack);
    return slot.save(true);
  };
  CHECK_NOTHROW(played.slot.check_stack(of(StackSettings{.depth = 3})));
  CHECK_THROWS_WITH(
      played.slot.check_stack(of(StackSettings{.depth = 2})),
      "the state has a stack of 2 grey screens of 84 x 84; here, one has a stack of 3 grey screens "
      "of 84 x 84");
  CHECK_THROWS_WITH(played.slot.check_stack(of(StackSettings{.depth = 3, .width = 42, .height = 168})),
                    Catch::Contains("of 42 x 168"));
  CHECK_THROWS_WITH(played.slot.check_stack(of({})), Catch::Contains("the state has no stack of screens"));
  Slot without({test::counter_image(), test::game()}, Played::settings());
  CHECK_NOTHROW(without.check_stack(played.slot.save(true)));
}

}  // namespace
}  // namespace racebeam
