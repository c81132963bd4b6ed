// Many machines, of one game or of several, that are stepped together. Where they run, and what becomes of
// what they show, is left to a VectorHost: a Batch runs them on threads and fills arrays (batch.hpp); the
// line protocol's `open` runs them in slices of time and writes text (protocol/line/machines.hpp).
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "environment/vector/slot.hpp"

namespace racebeam {

// What becomes of a machine whose episode is over, as in Gymnasium.
enum class Autoreset {
  kNextStep,  // its next step resets, whatever the action
  kSameStep,  // it is reset at once; the last observation is told beside the new one
  kDisabled   // nothing moves until it is reset
};

class VectorHost {
 public:
  virtual ~VectorHost() = default;

  // Runs task(0) ... task(count - 1), on several threads if it likes, and returns when all are done. A task
  // does not throw.
  virtual void run_all(std::size_t count, const std::function<void(std::size_t)>& task) = 0;

  virtual Pace* pace(std::size_t) { return nullptr; }  // of a machine

  // Called from within a machine's task. Each may throw what is to become of the request.
  virtual void opened(std::size_t number, Slot& slot) = 0;  // it is there
  virtual void ended(std::size_t number,
                     const Slot& slot) = 0;  // Autoreset::kSameStep: it will be reset at once
  virtual void shown(std::size_t number, const Slot& slot) = 0;  // it has done what was asked
};

class VectorEnvironment {
 public:
  // A machine for each cartridge, powered on and reset. random_seed is the first machine's; the n-th after it
  // has n more. `host` outlives the environment. Throws the first machine's failure, as Slot does.
  VectorEnvironment(std::span<const Cartridge> cartridges, const SlotSettings& settings, Autoreset autoreset,
                    VectorHost& host);

  std::size_t size() const { return slots_.size(); }
  Autoreset autoreset() const { return autoreset_; }
  Slot& slot(std::size_t number) { return *slots_[number]; }
  const Slot& slot(std::size_t number) const { return *slots_[number]; }

  // One act each. A machine whose episode is over does what Autoreset says. Throws the failure of the first
  // machine that has one.
  void step(std::span<const Act> acts);

  // New episodes, for those machines whose byte is not 0; empty: for all. The others are shown as they are. A
  // seed from 0 on is that of the machine's reset (Slot::reset()); a negative one, or none, is no seed.
  void reset(std::span<const std::uint8_t> chosen = {}, std::span<const std::int64_t> seeds = {});

  // The same for one machine, on the caller's thread; different machines at the same time. Throw its failure.
  void step_one(std::size_t number, const Act& act);
  void reset_one(std::size_t number, std::int64_t seed);

 private:
  template <typename Task>
  void run(Task task);  // task(number) for each machine

  const Autoreset autoreset_;
  VectorHost& host_;
  std::vector<std::unique_ptr<Slot>> slots_;
  std::vector<std::exception_ptr> failures_;
};

}  // namespace racebeam
