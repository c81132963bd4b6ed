#include "protocol/branch.hpp"

#include "protocol/session.hpp"

namespace racebeam {

void RewardRuns::add(std::int64_t reward) {
  if (!runs_.empty() && runs_.back().reward == reward) {
    ++runs_.back().times;
  } else {
    runs_.push_back({reward, 1});
  }
}

void RewardRuns::append(std::string& out) const {
  for (const Run& run : runs_) {
    if (&run != runs_.data()) out += ',';
    append_number(out, run.reward);
    if (run.times == 1) continue;
    out += '*';
    append_number(out, std::int64_t{run.times});
  }
}

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
      rewards_.add(branching_->act({action.a, action.b, action.strength_a, action.strength_b}));
      rewards_b_.add(session.player->machine().rewards().b);
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
  rewards_b_.clear();
  inside_ = true;
}

void BranchWork::leave(Session& session) {
  const BranchEnd& end = branching_->end();
  const bool for_two = session.player->machine().game().has_second_reward();
  std::string& out = session.out;
  out += " |";
  append_pair(out, "reward", end.reward);
  if (for_two) append_pair(out, "reward_b", end.reward_b);
  append_pair(out, "acts", end.acts);
  append_pair(out, "terminated", end.terminated);
  append_pair(out, "truncated", end.truncated);
  append_pair(out, "lives", end.lives);
  append_pair(out, "rewards", "");
  rewards_.append(out);
  if (for_two) {
    append_pair(out, "rewards_b", "");
    rewards_b_.append(out);
  }
  if (!keep.empty()) {
    const std::string name = keep + std::to_string(current_);
    session.states[name] = {session.player->machine().save(root.with_random), {}, root.with_random};
    append_pair(out, "state", name);
  }
  session.count({end.reward, end.reward_b, end.acts, end.frames});
  inside_ = false;
  ++current_;
}

}  // namespace racebeam
