// An agent of the benchmark: it sees a machine after each decision, and chooses the next action.
#pragma once

#include <cstdint>

#include "agents/base/state_bytes.hpp"
#include "environment/environment.hpp"

namespace racebeam {

class Agent {
 public:
  virtual ~Agent() = default;

  // Which screens the agent reads. The answer affects speed only.
  virtual Drawing drawing() const { return Drawing::kNone; }

  // Returns the first action of an episode, from 0 to 17.
  virtual int begin(const Environment& environment) = 0;

  // Returns the next action. reward: that of the action before.
  virtual int next(double reward, const Environment& environment) = 0;

  // Called when the episode is over. reward: that of its last action.
  virtual void end(double reward) = 0;

  // Switches learning on, as it is at first, or off for evaluation.
  virtual void set_learning(bool) {}

  // Whether the values that the agent learns are no longer finite.
  virtual bool diverged() const { return false; }

  // Frames that the agent's searches have run on its own machine.
  virtual std::int64_t searched_frames() const { return 0; }

  // Write and read what an agent keeps from one episode to the next. An agent with the same context that
  // reads this state continues like the agent that wrote it.
  virtual void write(StateWriter& out) const = 0;
  virtual void read(StateReader& in) = 0;
};

}  // namespace racebeam
