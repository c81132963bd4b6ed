// An agent of the benchmark: it sees a machine after each decision, and chooses the next action.
#pragma once

#include <cstdint>

#include "agents/base/state_bytes.hpp"
#include "environment/environment.hpp"

namespace racebeam {

class Agent {
 public:
  virtual ~Agent() = default;

  // The screens that the agent reads. It changes only the speed.
  virtual Drawing drawing() const { return Drawing::kNone; }

  // Returns the first action of an episode, from 0 to 17.
  virtual int begin(const Environment& environment) = 0;

  // `reward` is of the action before. Returns the next action.
  virtual int next(double reward, const Environment& environment) = 0;

  // The episode is over; `reward` is of its last action.
  virtual void end(double reward) = 0;

  // An agent begins with learning. Evaluation switches it off.
  virtual void set_learning(bool) {}

  // Whether the values that the agent learns are no longer finite.
  virtual bool diverged() const { return false; }

  // Frames that the agent has tried on its own machine, in searches.
  virtual std::int64_t searched_frames() const { return 0; }

  // What an agent carries from one episode to the next. An agent that was made with the same context, and has
  // read this state, goes on as the one that wrote it.
  virtual void write(StateWriter& out) const = 0;
  virtual void read(StateReader& in) = 0;
};

}  // namespace racebeam
