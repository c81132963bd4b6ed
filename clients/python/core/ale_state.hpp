// A state of a game, in memory or as bytes.
#pragma once

#include <memory>
#include <string>

#include "clients/python/core/lock.hpp"
#include "environment/environment.hpp"

namespace racebeam::python {

// An environment that states refer to, with the lock of the interface that it belongs to.
struct Machine {
  Machine(std::shared_ptr<Lock> its_lock, std::shared_ptr<const Image> image,
          std::shared_ptr<const Game> game, const Settings& settings)
      : lock(std::move(its_lock)), environment(std::move(image), std::move(game), settings) {}

  const std::shared_ptr<Lock> lock;
  Environment environment;
};

class AleState {
 public:
  // Values that a state has without a machine.
  struct Facts {
    int frame = 0, episode_frame = 0, difficulty = 0, mode = 0;
  };

  AleState() = default;  // a state without a game

  // Saves the machine's present state; the caller holds the lock.
  AleState(std::shared_ptr<Machine> machine, bool with_random);

  // Takes bytes of serialize(). Throws InvalidInput unless they begin as such bytes do; the rest is checked
  // when the state is restored.
  explicit AleState(std::string bytes);

  // Throws InvalidInput if the state belongs to another image or game than the environment's; the environment
  // is then unchanged. The caller holds the lock.
  void restore_in(Environment& environment) const;

  // Takes the machine's lock. Returns "" for a state without a game.
  std::string serialize() const;
  bool equals(const AleState& other) const;
  const Facts& facts() const { return facts_; }

 private:
  Facts facts_;
  std::shared_ptr<Machine> machine_;  // null: the state came as bytes
  std::shared_ptr<const Environment::Saved> saved_;
  std::string bytes_;
};

}  // namespace racebeam::python
