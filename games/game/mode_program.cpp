#include "games/game/mode_program.hpp"

#include <algorithm>
#include <array>

#include "games/game/game.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

class Runner {
 public:
  Runner(const Game& game, Rule& rule, int mode, ModeHost& host)
      : game_(game), rule_(rule), mode_(mode), host_(host) {
    variables_[kModeSlot] = mode;
  }

  void run(const std::vector<Statement>& statements) {
    for (const Statement& statement : statements) run(statement);
  }

 private:
  void run(const Statement& statement) {
    switch (statement.kind) {
      case Statement::Kind::kAssign: return assign(statement.target, value(statement));
      case Statement::Kind::kSelect: return host_.select(frames(statement));
      case Statement::Kind::kAct: return host_.act(statement.target, frames(statement));
      case Statement::Kind::kSoftReset: return host_.soft_reset();
      case Statement::Kind::kWhile: return loop(statement);
      case Statement::Kind::kIf: return run(value(statement) != 0 ? statement.body : statement.otherwise);
      case Statement::Kind::kFail: give_up(statement.text);
    }
  }

  // The value, as a number of frames or acts that the program asks for.
  int frames(const Statement& statement) {
    const std::int32_t count = value(statement);
    requests_ += std::max(count, 0);
    if (requests_ > kModeFrames)
      give_up("it asks for more than " + std::to_string(kModeFrames) + " frames and acts");
    return count;
  }

  void loop(const Statement& statement) {
    while (value(statement) != 0) {
      if (++turns_ > kModeTurns) give_up("the console did not reach the mode");
      run(statement.body);
    }
  }

  // The rule's variables change between statements, because frames pass.
  std::int32_t value(const Statement& statement) {
    std::ranges::copy(rule_.state().values, variables_.begin());
    if (statement.draws) variables_[kRandomSlot] = static_cast<std::int32_t>(host_.random());
    return evaluate(statement.expression, variables_.data(), host_.memory());
  }

  void assign(int slot, std::int32_t value) {
    if (slot >= kMaxVariables) {
      variables_[static_cast<std::size_t>(slot)] = value;
      return;
    }
    RuleState state = rule_.state();
    state.values[static_cast<std::size_t>(slot)] = value;
    rule_.restore(state);
  }

  [[noreturn]] void give_up(const std::string& why) const {
    throw InvalidInput("mode " + std::to_string(mode_) + " of " + game_.name +
                       " could not be set up on this image: " + why);
  }

  const Game& game_;
  Rule& rule_;
  int mode_;
  ModeHost& host_;
  std::array<std::int32_t, kMaxModeVariables> variables_{};
  int turns_ = 0;
  std::int64_t requests_ = 0;  // frames of `select` and acts
};

}  // namespace

void run_mode_program(const Game& game, Rule& rule, int mode, ModeHost& host) {
  Runner(game, rule, mode, host).run(game.mode_program.statements);
}

}  // namespace racebeam
