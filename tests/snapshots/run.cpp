#include "tests/snapshots/run.hpp"

#include <cstring>
#include <span>

namespace racebeam::test {
namespace {

std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ value >> 32) * 0xD6E8FEB86659FD93;
  return value ^ value >> 29;
}

// Eight bytes at a time, in four sums, so that a digest takes less time than a frame.
class Hash {
 public:
  void add(std::span<const std::uint8_t> bytes) {
    std::size_t at = 0, lane = 0;
    for (; at + 8 <= bytes.size(); at += 8, lane = (lane + 1) % 4) {
      std::uint64_t word;
      std::memcpy(&word, bytes.data() + at, sizeof word);
      sum_[lane] = (sum_[lane] ^ word) * 0x9E3779B97F4A7C15;
      sum_[lane] ^= sum_[lane] >> 32;
    }
    for (; at < bytes.size(); ++at) add(bytes[at]);
  }
  void add(std::int64_t number) { sum_[0] = mixed(sum_[0] ^ static_cast<std::uint64_t>(number)); }
  std::uint64_t value() const {
    return mixed(mixed(mixed(sum_[0]) + sum_[1]) + mixed(mixed(sum_[2]) + sum_[3]));
  }

 private:
  std::uint64_t sum_[4] = {1, 2, 3, 4};
};

}  // namespace

Manner manner(int number) {
  Settings settings;
  settings.random_seed = 11;
  settings.sound = true;
  settings.sticky = 0;
  if (number == 0) return {"sticky 0, without the generator", settings, false};
  settings.sticky = 0.25F;
  settings.color_averaging = true;
  return {"sticky 0.25, with the generator, averaged colours", settings, true};
}

std::uint64_t digest(const Environment& environment, int reward) {
  Hash hash;
  hash.add(environment.screen());
  hash.add(environment.ram());
  hash.add(environment.audio());
  for (const int number : {reward, environment.lives(), int{environment.terminal()},
                           int{environment.truncated()}, environment.frame_number(),
                           environment.episode_frame_number(), environment.mode(), environment.difficulty()})
    hash.add(number);
  return hash.value();
}

std::uint64_t act(Environment& environment, std::uint64_t seed, int n) {
  const auto& legal = environment.game().legal_actions;
  const std::uint64_t draw = mixed(mixed(seed) + static_cast<std::uint64_t>(n / 4));  // held for four acts
  const int reward = environment.act(legal[draw % legal.size()]);
  const std::uint64_t value = digest(environment, reward);
  if (environment.game_over()) environment.reset_game();
  return value;
}

}  // namespace racebeam::test
