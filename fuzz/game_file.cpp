// A game file is read. If it is accepted, its rule and its modes are executed on random memory.
#include "games/files/game_file.hpp"

#include <array>

#include "fuzz/support/target.hpp"
#include "games/game/mode_program.hpp"
#include "games/game/rule.hpp"

namespace racebeam::fuzz {
namespace {

constexpr int kFrames = 16, kModes = 4;

// Memory that changes with each frame. It throws after some frames, to end programs that never end.
class Host final : public ModeHost {
 public:
  Memory memory() override { return {ram_.data(), peek, this}; }
  void select(int) override { pass(); }
  void act(int action, int) override {
    require(action >= 0 && action < 18, "a mode program plays actions of player A");
    pass();
  }
  void soft_reset() override { pass(); }
  std::uint32_t random() override { return pass(), state_; }

  void pass() {
    for (std::uint8_t& byte : ram_)
      byte = static_cast<std::uint8_t>((state_ = state_ * 1664525 + 1013904223) >> 24);
  }

 private:
  static std::uint8_t peek(const void* machine, std::uint16_t address) {
    return static_cast<const Host*>(machine)->ram_[address % 128U];
  }

  std::array<std::uint8_t, 128> ram_{};
  std::uint32_t state_ = 1;
};

void play(const Game& game, Rule& rule, Host& host) {
  rule.reset();
  for (int frame = 0; frame < kFrames; ++frame) {
    host.pass();
    rule.step(host.memory());
    const RuleState before = rule.state();
    rule.reward();
    rule.reward_b();
    rule.terminal();
    rule.lives();
    require(rule.state() == before, "queries change nothing");
  }
  require(game.has_second_reward() || rule.reward_b() == 0,
          "player B gets nothing where the rule has one player");
}

void try_modes(const Game& game, Rule& rule, Host& host) {
  int tried = 0;
  for (const int mode : game.offered_modes()) {
    if (++tried > kModes) return;
    try {
      run_mode_program(game, rule, mode, host);
    } catch (const std::invalid_argument& refusal) {
      require(*refusal.what() != '\0', "a mode that is not reached gives an error");
    }
  }
}

}  // namespace

void run(Bytes input) {
  Game game;
  try {
    game = parse_game(text_of(input), "fuzzed", "fuzzed.toml");
  } catch (const std::invalid_argument& refusal) {
    require(std::string_view(refusal.what()).starts_with("fuzzed.toml:"), "an error names the file",
            refusal.what());
    return;
  }
  Host host;
  for (const Game* each : {static_cast<const Game*>(&game), game.fixed.get()}) {
    if (each == nullptr) continue;
    Rule rule(*each);
    play(*each, rule, host);
    try_modes(*each, rule, host);
  }
}

}  // namespace racebeam::fuzz
