// `branch`: from one state, several lists of actions; what planners do all day.
#pragma once

#include <string>
#include <vector>

#include "protocol/line/loaded_machine.hpp"

namespace racebeam {

class Session;

struct BranchRequest {
  Slot::Saved root;
  std::vector<std::vector<Action>> lists;
  std::string keep;  // the ends are saved as this name with 0, 1, 2 ... behind it; empty: they are not
};

// Appends the reply to session.out. The session's machine is where it was afterwards, whatever is thrown.
void play_branches(Session& session, const BranchRequest& request);

}  // namespace racebeam
