#include "protocol/branch.hpp"

#include "protocol/session.hpp"

namespace racebeam {

void BranchWork::begin(Session& session) {
  undisturbed_ = session.player->place(true);
  session.player->machine().watch({});  // no recording of what did not happen
  current_ = 0;
  inside_ = false;
  session.out += "ok";
  append_pair(session.out, "branches", static_cast<std::int64_t>(branches.size()));
}

bool BranchWork::go_on(Session& session, int& frames) {
  Environment& machine = session.player->machine();
  while (current_ < branches.size()) {
    if (!inside_) enter(session);
    ActionQueue& queue = branches[current_];
    while (!queue.empty() && !machine.game_over()) {
      if (frames <= 0) return false;
      const int before = machine.frame_number();
      const Action& action = queue.take();
      add(machine.act(action.a, action.b, action.strength_a, action.strength_b));
      const int ran = machine.frame_number() - before;
      frames -= ran;
      frames_ += ran;
    }
    leave(session);
  }
  give_up(session);
  return true;
}

void BranchWork::give_up(Session& session) {
  session.player->go_to(undisturbed_);
  session.watch();
}

// A state without a generator goes on with the session's, for every branch from the same place in it.
void BranchWork::enter(Session& session) {
  Environment& machine = session.player->machine();
  machine.restore(*undisturbed_.machine);
  machine.restore(*root.machine);
  rewards_.clear();
  acts_ = frames_ = 0;
  inside_ = true;
}

void BranchWork::add(std::int64_t reward) {
  ++acts_;
  if (!rewards_.empty() && rewards_.back().reward == reward) {
    ++rewards_.back().times;
  } else {
    rewards_.push_back({reward, 1});
  }
}

void BranchWork::leave(Session& session) {
  const Environment& machine = session.player->machine();
  std::string& out = session.out;
  std::int64_t sum = 0;
  for (const auto [reward, times] : rewards_) sum += reward * times;
  out += " |";
  append_pair(out, "reward", sum);
  append_pair(out, "acts", acts_);
  append_pair(out, "terminated", machine.terminal());
  append_pair(out, "truncated", machine.truncated());
  append_pair(out, "lives", machine.lives());
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
    session.states[name] = {machine.save(root.with_random), {}, root.with_random};
    append_pair(out, "state", name);
  }
  session.count({sum, 0, acts_, frames_});
  inside_ = false;
  ++current_;
}

}  // namespace racebeam
