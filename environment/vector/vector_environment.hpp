// Many machines, of one game or of several, that are stepped together. A VectorHost decides where they run
// and collects their results. There are two: a Batch runs them on threads and fills arrays (batch.hpp); the
// line protocol's `open` runs them in slices of time and writes text (protocol/line/machines.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "environment/vector/slot.hpp"

namespace racebeam {

// What happens to a machine whose episode is over, as in Gymnasium.
enum class Autoreset {
  kNextStep,  // its next step resets it and ignores the action
  kSameStep,  // the same step resets it, and reports the last observation beside the new one
  kDisabled   // its steps do nothing until the caller resets it
};

// A negative seed means unseeded.
std::optional<std::uint32_t> seed_of(std::int64_t seed);

class VectorHost {
 public:
  virtual ~VectorHost() = default;

  // Runs task(0) ... task(count - 1), on one thread or several, and returns when all are done. A task does
  // not throw. May end the request by throwing, when no task is in progress.
  virtual void run_all(std::size_t count, const std::function<void(std::size_t)>& task) = 0;

  virtual Pace* pace(std::size_t /*number*/) { return nullptr; }  // of this machine; null: none

  // Called from within a machine's task. What they throw is the failure of that machine.
  virtual void opened(std::size_t number, Slot& slot) = 0;       // after it was made
  virtual void ended(std::size_t number, const Slot& slot) = 0;  // Autoreset::kSameStep: before its reset
  virtual void show(std::size_t number, const Slot& slot) = 0;   // at the end of each request
};

class VectorEnvironment {
 public:
  // Creates a machine for each cartridge, powers it on and resets it. settings.machine.random_seed is the
  // seed of machine 0; machine n has n more. `host` must outlive the environment. Throws what Slot throws,
  // for the first machine that fails, and what host.run_all() throws.
  VectorEnvironment(std::span<const Cartridge> cartridges, const SlotSettings& settings, Autoreset autoreset,
                    VectorHost& host);

  std::size_t size() const { return slots_.size(); }
  Autoreset autoreset() const { return autoreset_; }
  Slot& slot(std::size_t number) { return *slots_[number]; }
  const Slot& slot(std::size_t number) const { return *slots_[number]; }

  // Steps every machine: acts[n] is of machine n. A machine whose episode is over is handled according to
  // Autoreset. Throws the failure of the first machine that has one; those after it may have done nothing.
  // Throws what host.run_all() throws. Each machine has then made its step, or is as it was.
  void step(std::span<const Act> acts);

  // Begins new episodes of the machines whose byte in `mask` is not 0; of all if `mask` is empty. The
  // other machines are shown as they are. A seed of 0 or more goes to Slot::reset(); a negative one means
  // none. Throws as step() does.
  void reset(std::span<const std::uint8_t> mask = {}, std::span<const std::int64_t> seeds = {});

  // Step and reset one machine, on the caller's thread. Callers may use different machines at the same time.
  // Both throw the machine's failure.
  void step_one(std::size_t number, const Act& act);
  void reset_one(std::size_t number, std::int64_t seed);

 private:
  template <typename Task>
  void run(Task task);  // task(number) for each machine

  const Autoreset autoreset_;
  VectorHost& host_;
  std::vector<std::unique_ptr<Slot>> slots_;
};

}  // namespace racebeam
