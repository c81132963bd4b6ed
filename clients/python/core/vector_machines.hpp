// A Batch that Python can reach. Its threads do not survive a fork, so every use in a child process is
// refused.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "clients/python/core/lock.hpp"
#include "clients/python/core/signals.hpp"
#include "environment/vector/batch.hpp"

namespace racebeam::python {

// Calls that XLA makes (bind_xla.cpp) share it with the object of Python, and may outlive that.
class SharedBatch {
 public:
  // Throws what a signal handler raises meanwhile.
  SharedBatch(std::span<const Cartridge> cartridges, const BatchSettings& settings)
      : cartridges_(cartridges.begin(), cartridges.end()),
        batch_(std::make_unique<Batch>(cartridges, settings, look_for_signals)) {}
  ~SharedBatch();
  SharedBatch(const SharedBatch&) = delete;
  SharedBatch& operator=(const SharedBatch&) = delete;

  Lock& lock() { return lock_; }

  const Cartridge& cartridge(std::size_t machine) const { return cartridges_[machine]; }

  // The caller holds lock(). Throws std::runtime_error in a child of the process that made the machines.
  // `interrupt_check`: for the requests that follow (Batch::set_interrupt_check()).
  Batch& batch(InterruptCheck interrupt_check);

 private:
  bool is_forked() const { return made_in_ != process_generation(); }

  const unsigned made_in_ = process_generation();
  Lock lock_;
  const std::vector<Cartridge> cartridges_;  // one for each machine
  std::unique_ptr<Batch> batch_;
};

class VectorMachines {
 public:
  VectorMachines(std::span<const Cartridge> cartridges, const BatchSettings& settings)
      : shared_(std::make_shared<SharedBatch>(cartridges, settings)) {}

  // See SharedBatch.
  Lock& lock() { return shared_->lock(); }
  Batch& batch() { return shared_->batch(look_for_signals); }
  const Cartridge& cartridge(std::size_t machine) const { return shared_->cartridge(machine); }

  std::weak_ptr<SharedBatch> shared() const { return shared_; }

 private:
  std::shared_ptr<SharedBatch> shared_;
};

}  // namespace racebeam::python
