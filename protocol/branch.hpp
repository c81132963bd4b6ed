// `branch`: from one state, several lists of actions; what planners do all day.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "environment/branch.hpp"
#include "protocol/player.hpp"
#include "protocol/work.hpp"

namespace racebeam {

// The rewards of one act after the other, runs of equal ones together.
class RewardRuns {
 public:
  void clear() { runs_.clear(); }
  void add(std::int64_t reward);
  void append(std::string& out) const;  // R,R*TIMES,...

 private:
  struct Run {
    std::int64_t reward;
    int times;
  };
  std::vector<Run> runs_;
};

class BranchWork final : public Work {
 public:
  // To be filled before the work starts.
  Place root;
  std::vector<ActionQueue> branches;
  std::string keep;  // the ends are saved as this name with 0, 1, 2 ... behind it; empty: they are not

  void begin(Session& session);
  bool go_on(Session& session, int& frames) override;
  void give_up(Session& session) override;

 private:
  void enter();
  void leave(Session& session);

  Place undisturbed_;  // where the session is, generator and stack included
  std::optional<Branching> branching_;
  std::size_t current_ = 0;
  bool inside_ = false;  // the machine stands in branches[current_]
  RewardRuns rewards_, rewards_b_;
};

}  // namespace racebeam
