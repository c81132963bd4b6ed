#include "protocol/branch.hpp"

#include "protocol/session.hpp"

namespace racebeam {

void BranchWork::begin(Session& session) {
  undisturbed_ = session.player->place(true);
  session.player->machine().watch({});  // no recording of what did not happen
  branching_.emplace(session.player->machine());
  current_ = 0;
  inside_ = false;
  session.out += "ok";
  append_pair(session.out, "branches", static_cast<std::int64_t>(branches.size()));
}

bool BranchWork::go_on(Session& session, int& frames) {
  while (current_ < branches.size()) {
    if (!inside_) enter();
    ActionQueue& queue = branches[current_];
    while (!queue.empty() && !branching_->over()) {
      if (frames <= 0) return false;
      const int before = branching_->end().frames;
      const Action& action = queue.take();
      add(branching_->act({action.a, action.b, action.strength_a, action.strength_b}));
      frames -= branching_->end().frames - before;
    }
    leave(session);
  }
  give_up(session);
  return true;
}

void BranchWork::give_up(Session& session) {
  session.player->go_to(undisturbed_);
  session.watch();
  branching_.reset();
}

void BranchWork::enter() {
  branching_->enter(*root.machine);
  rewards_.clear();
  inside_ = true;
}

void BranchWork::add(std::int64_t reward) {
  if (!rewards_.empty() && rewards_.back().reward == reward) {
    ++rewards_.back().times;
  } else {
    rewards_.push_back({reward, 1});
  }
}

void BranchWork::leave(Session& session) {
  const BranchEnd& end = branching_->end();
  std::string& out = session.out;
  out += " |";
  append_pair(out, "reward", end.reward);
  append_pair(out, "acts", end.acts);
  append_pair(out, "terminated", end.terminated);
  append_pair(out, "truncated", end.truncated);
  append_pair(out, "lives", end.lives);
  append_pair(out, "rewards", "");
  for (std::size_t i = 0; i < rewards_.size(); ++i) {
    if (i > 0) out += ',';
    append_number(out, rewards_[i].reward);
    if (rewards_[i].times == 1) continue;
    out += '*';
    append_number(out, std::int64_t{rewards_[i].times});
  }
  if (!keep.empty()) {
    const std::string name = keep + std::to_string(current_);
    session.states[name] = {session.player->machine().save(root.with_random), {}, root.with_random};
    append_pair(out, "state", name);
  }
  session.count({end.reward, 0, end.acts, end.frames});
  inside_ = false;
  ++current_;
}

}  // namespace racebeam
