#include "tests/golden/work.hpp"

#include <zlib.h>

#include <cstdio>
#include <random>

#include "environment/saved/saved_state_format.hpp"

namespace racebeam::test {
namespace {

// The output of the acts of one line.
struct Fold {
  std::uint32_t screen = 0, ram = 0, audio = 0;
  long reward = 0;
  int ends = 0;

  void add(const Environment& environment, int gained) {
    add(screen, environment.screen());
    add(ram, environment.ram());
    add(audio, environment.audio());
    reward += gained;
    ends += environment.game_over() ? 1 : 0;
  }

 private:
  static void add(std::uint32_t& sum, std::span<const std::uint8_t> bytes) {
    sum = static_cast<std::uint32_t>(crc32(sum, bytes.data(), static_cast<uInt>(bytes.size())));
  }
};

std::string line(int acts, const Fold& fold, int lives) {
  char text[96];
  std::snprintf(text, sizeof text, "%6d %08x %08x %08x %6ld %5d %4d\n", acts, fold.screen, fold.ram,
                fold.audio, fold.reward, lives, fold.ends);
  return text;
}

std::string state_line(const Environment& environment) {
  const auto bytes = to_bytes(*environment.save(true), environment);
  char text[24];
  std::snprintf(text, sizeof text, "state %08lx\n", crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
  return text;
}

Environment switched_on(const Work& work) {
  Environment environment(work.image, work.game, work.settings);
  if (work.mode == environment.mode() && work.difficulty == environment.difficulty()) return environment;
  environment.set_mode(work.mode);
  environment.set_difficulty(work.difficulty);
  environment.reset_game();
  return environment;
}

// Plays random actions, and returns the lines.
std::string play(Environment& environment, const Work& work, int acts, unsigned seed) {
  std::mt19937 random(seed);
  const auto& legal = work.game->legal_actions;
  std::string text;
  Fold fold;
  for (int act = 1; act <= acts; ++act) {
    const int reward = environment.act(legal[random() % legal.size()]);
    fold.add(environment, reward);
    if (environment.game_over()) environment.reset_game();
    if (act % work.acts_a_line != 0 && act != acts) continue;
    text += line(act, fold, environment.lives());
    fold = {};
  }
  return text;
}

std::string second_half(Environment& environment, const Work& work) {
  const std::string text = play(environment, work, work.acts - work.acts / 2, 2);
  return text + state_line(environment);
}

}  // namespace

const std::string kColumns = "  acts   screen      ram    audio reward lives ends\n";

std::string played(const Work& work, bool with_state) {
  Environment environment = switched_on(work);
  const std::string text = play(environment, work, work.acts, 1);
  return with_state ? text + state_line(environment) : text;
}

Halves played_in_halves(const Work& work) {
  Environment environment = switched_on(work);
  play(environment, work, work.acts / 2, 1);
  std::vector<std::uint8_t> state = to_bytes(*environment.save(true), environment);
  return {std::move(state), second_half(environment, work)};
}

std::string continued(const Work& work, std::span<const std::uint8_t> state) {
  Environment environment(work.image, work.game, work.settings);
  environment.restore(*from_bytes(state, environment));
  return second_half(environment, work);
}

}  // namespace racebeam::test
