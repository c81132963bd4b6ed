// `branch` plays several lists of actions from one state. Planners call it most.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "protocol/line/loaded_machine.hpp"

namespace racebeam {

class Context;
class Reply;

// Up to half a million lists of actions, stored contiguously.
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
  std::string keep;  // the ends are saved under this name, followed by 0, 1, 2 ...; empty: not saved
};

// Writes the reply. Afterwards, the session's machine is in its old state, even after an exception.
void play_branches(Context& context, const BranchRequest& request, Reply& reply);

}  // namespace racebeam
