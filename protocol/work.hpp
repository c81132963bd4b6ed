// Requests that can take long are done in slices.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/action.hpp"

namespace racebeam {

class Session;

class Work {
 public:
  virtual ~Work() = default;

  // Does a part of about `frames` frames, which it takes off. True when all is done and the reply is in
  // session.out. Throws like a handler.
  virtual bool go_on(Session& session, int& frames) = 0;

  // After a throw: leaves the session as a refused request must.
  virtual void give_up(Session&) {}
};

// A list of actions, and how far they are.
struct ActionQueue {
  std::vector<Action> actions;
  std::size_t next = 0;
  int repeated = 0;  // of actions[next]

  bool empty() const { return next == actions.size(); }
  const Action& take();
  std::int64_t acts() const;  // in all
};

// The actions of one `act`; ends early with the episode.
class ActWork final : public Work {
 public:
  ActionQueue queue;
  bool go_on(Session& session, int& frames) override;
};

}  // namespace racebeam
