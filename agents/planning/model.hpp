// What a planner knows of the world: it can try actions from any state, and return.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace racebeam {

constexpr std::size_t kByteValues = 256;  // of a feature

class Model {
 public:
  // A state, as the model keeps it. A planner only hands it back.
  using State = std::shared_ptr<const void>;

  virtual ~Model() = default;

  virtual int actions() const = 0;  // they are 0 to actions() - 1

  // One place is the present one. enter() goes to a state, act() plays from there, save() keeps it.
  virtual void enter(const State& state) = 0;
  virtual double act(int action) = 0;  // returns the reward
  virtual bool over() const = 0;
  virtual State save() const = 0;

  // Equal states have the same hash, and the same future under the same actions.
  virtual std::uint64_t hash(const State& state) const = 0;
  virtual bool equal(const State& a, const State& b) const = 0;

  // Bytes that tell places apart by their features, of the present place: a machine's RAM.
  virtual std::span<const std::uint8_t> features() const = 0;

  virtual std::int64_t frames() const = 0;  // that all actions took so far
};

}  // namespace racebeam
