// `branch`: from one state, several lists of actions; what planners do all day.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "protocol/line/loaded_machine.hpp"

namespace racebeam {

class Context;
class Reply;

// Up to half a million lists of actions, one after the other in one piece of memory.
struct ActionLists {
  std::vector<Action> actions;
  std::vector<std::size_t> ends;  // per list, in `actions`

  std::size_t size() const { return ends.size(); }
  std::span<const Action> operator[](std::size_t list) const {
    const std::size_t begin = list == 0 ? 0 : ends[list - 1];
    return std::span(actions).subspan(begin, ends[list] - begin);
  }
};

struct BranchRequest {
  Slot::Saved root;
  ActionLists lists;
  std::string keep;  // the ends are saved as this name with 0, 1, 2 ... behind it; empty: they are not
};

// Writes the reply. The session's machine is where it was afterwards, whatever is thrown.
void play_branches(Context& context, const BranchRequest& request, Reply& reply);

}  // namespace racebeam
