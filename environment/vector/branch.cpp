#include "environment/vector/branch.hpp"

#include <stdexcept>
#include <string>

#include "environment/saved_state.hpp"

namespace racebeam {

Branching::Branching(Environment& environment, LifeLoss life_loss)
    : environment_(environment),
      life_loss_(life_loss),
      undisturbed_(environment.save(true)),
      drawing_(environment.drawing()) {}

void Branching::enter(const Environment::Saved& root) {
  environment_.set_drawing(Drawing::kNone);
  if (!root.random) environment_.restore(*undisturbed_);
  environment_.restore(root);
  end_ = {};
  life_ended_ = false;
  end_.lives = environment_.lives();
  check_ends();
}

void Branching::check_ends() {
  const bool lost_life = 0 < environment_.lives() && environment_.lives() < end_.lives;
  const Ends ends = ends_of(environment_, life_loss_);
  const bool reported = life_loss_ == LifeLoss::kReported && (lost_life || end_.terminated);
  life_ended_ |= life_loss_ == LifeLoss::kEnd && lost_life;
  end_.terminated = ends.terminated || life_ended_ || reported;
  end_.truncated = ends.truncated;
  end_.lives = environment_.lives();
}

int Branching::act(const Act& act) {
  const int before = environment_.frame_number();
  const int reward = environment_.act(act);
  end_.reward += reward;
  end_.reward_b += environment_.rewards().b;
  ++end_.acts;
  end_.frames += frames_between(before, environment_.frame_number());
  check_ends();
  return reward;
}

Branching::~Branching() {
  environment_.set_drawing(drawing_);
  environment_.restore(*undisturbed_);
}

void branch(Environment& environment, const Environment::Saved& root,
            std::span<const std::vector<Act>> sequences, std::span<BranchEnd> ends) {
  if (sequences.size() != ends.size()) {
    throw std::invalid_argument("there is room for " + std::to_string(ends.size()) + " results of " +
                                std::to_string(sequences.size()) + " branches");
  }
  Branching branching(environment);
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    branching.enter(root);
    for (const Act& act : sequences[i]) {
      if (branching.over()) break;
      branching.act(act);
    }
    ends[i] = branching.end();
  }
}

}  // namespace racebeam
