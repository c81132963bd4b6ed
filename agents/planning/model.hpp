// The world as a planner uses it: a simulator in which it tries actions from any state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace racebeam {

constexpr std::size_t kByteValues = 256;  // of a feature

class Model {
 public:
  // A state, which only the model can read. A planner passes it to enter().
  using State = std::shared_ptr<const void>;

  virtual ~Model() = default;

  virtual int actions() const = 0;  // how many there are; their numbers are 0 to actions() - 1

  // The model is in one state at a time: enter() changes it, act() plays an action from it, save() returns
  // it.
  virtual void enter(const State& state) = 0;
  virtual double act(int action) = 0;  // returns the reward
  virtual bool over() const = 0;       // whether the episode has ended in this state
  virtual State save() const = 0;

  // Equal states have the same hash, and the same future under the same actions.
  virtual std::uint64_t hash(const State& state) const = 0;
  virtual bool equal(const State& a, const State& b) const = 0;

  // The features of the present state, by which IW(1) tells whether it is novel: a machine's RAM.
  virtual std::span<const std::uint8_t> features() const = 0;

  virtual std::int64_t frames() const = 0;  // frames that all actions so far have taken
};

}  // namespace racebeam
