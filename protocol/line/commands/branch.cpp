#include "protocol/line/commands/branch.hpp"

#include <utility>

#include "environment/vector/branch.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "protocol/line/session_log.hpp"
#include "protocol/line/session_recording.hpp"

namespace racebeam {
namespace {

// The session's machine, lent to branches.
class Loan {
 public:
  explicit Loan(Context& context) : context_(context), undisturbed_(context.game.loaded->slot().save(true)) {
    context.game.loaded->machine().watch({});  // branches are neither recorded nor logged
    context.game.loaded->slot().set_watcher(nullptr);
  }
  ~Loan() {
    context_.game.loaded->slot().restore(undisturbed_);
    if (context_.media.recording) context_.media.recording->watch();
    if (context_.media.log) context_.media.log->watch();
  }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;

 private:
  Context& context_;
  const Slot::Saved undisturbed_;  // with generator and stack
};

// The state that `keep` saves at the end of a branch.
Slot::Saved leaf(const Slot::Saved& root, const Branching& branching,
                 std::shared_ptr<const Environment::Saved> machine) {
  const BranchEnd& end = branching.end();
  Slot::Saved saved{std::move(machine), {}, root.with_random, root.progress};
  saved.progress.score += end.reward;
  saved.progress.elapsed += end.frames;
  saved.progress.terminated = end.terminated;
  saved.progress.truncated = end.truncated;
  saved.progress.finished = branching.over();
  saved.progress.game_continues = branching.life_ended() && !end.truncated;
  saved.progress.blends = false;
  return saved;
}

class RewardRuns {  // the rewards of one act after the other, runs of equal ones together
 public:
  void add(std::int64_t reward) {
    if (!runs_.empty() && runs_.back().reward == reward) {
      ++runs_.back().times;
    } else {
      runs_.push_back({reward, 1});
    }
  }

  // Appends "R,R*TIMES,...".
  void append(std::string& out, Pacer& pacer) const {
    constexpr std::size_t kBetweenLooks = 4096;
    std::size_t appended = 0;
    for (const Run& run : runs_) {
      if (++appended % kBetweenLooks == 0) pacer.yield_if_due();
      if (&run != runs_.data()) out += ',';
      append_number(out, run.reward);
      if (run.times == 1) continue;
      out += '*';
      append_number(out, std::int64_t{run.times});
    }
  }

 private:
  struct Run {
    std::int64_t reward;
    int times;
  };
  std::vector<Run> runs_;
};

struct Rewards {
  RewardRuns a, b;
};

Rewards play(Branching& branching, const Environment& machine, std::span<const Action> actions) {
  Rewards rewards;
  for (const Action& action : actions) {
    for (int n = 0; n < action.times && !branching.over(); ++n) {
      rewards.a.add(branching.act(action.act));
      rewards.b.add(machine.rewards().b);
    }
  }
  return rewards;
}

void add_end(Reply& reply, const BranchEnd& end, const Rewards& rewards, bool for_two, Pacer& pacer) {
  reply.add_group();
  reply.add("reward", end.reward);
  if (for_two) reply.add("reward_b", end.reward_b);
  reply.add("acts", end.acts);
  reply.add("terminated", end.terminated);
  reply.add("truncated", end.truncated);
  reply.add("lives", end.lives);
  rewards.a.append(reply.add_long("rewards"), pacer);
  if (for_two) rewards.b.append(reply.add_long("rewards_b"), pacer);
}

}  // namespace

void play_branches(Context& context, const BranchRequest& request, Reply& reply) {
  std::vector<std::pair<std::string, Slot::Saved>> states;
  reply.add("branches", static_cast<std::int64_t>(request.lists.size()));
  {
    const Loan loan(context);
    Environment& machine = context.game.loaded->machine();
    Branching branching(machine, context.game.settings.life_loss);
    for (std::size_t i = 0; i < request.lists.size(); ++i) {
      branching.enter(*request.root.machine);
      const Rewards rewards = play(branching, machine, request.lists[i]);
      const BranchEnd& end = branching.end();
      add_end(reply, end, rewards, machine.game().has_second_reward(), context.pacer);
      context.count({.reward = end.reward, .reward_b = end.reward_b, .acts = end.acts, .frames = end.frames});
      context.pacer.yield_if_due();  // a list that ends at once runs no frame
      if (request.keep.empty()) continue;
      const std::string name = request.keep + std::to_string(i);
      reply.add("state", name);
      const bool with_random = request.root.with_random;
      states.emplace_back(name, leaf(request.root, branching, machine.save(with_random)));
      context.memory.check(states.back().second.footprint(), "a state");
    }
  }
  for (auto& [name, place] : states) context.game.states.put(name, std::move(place));
}

}  // namespace racebeam
