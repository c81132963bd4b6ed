// A Batch that Python can reach. Its threads do not survive a fork: a child process is refused each use.
#pragma once

#include <memory>
#include <span>

#include "clients/python/core/lock.hpp"
#include "environment/vector/batch.hpp"

namespace racebeam::python {

class VectorMachines {
 public:
  VectorMachines(std::span<const Cartridge> cartridges, const BatchSettings& settings)
      : settings_(settings), batch_(std::make_unique<Batch>(cartridges, settings)) {}
  ~VectorMachines();
  VectorMachines(const VectorMachines&) = delete;
  VectorMachines& operator=(const VectorMachines&) = delete;

  const BatchSettings& settings() const { return settings_; }
  Lock& lock() { return lock_; }

  // The caller holds lock(). Throws std::runtime_error in a child of the process that made the machines.
  Batch& batch();

 private:
  bool is_forked() const { return made_in_ != process_generation(); }

  const BatchSettings settings_;
  const unsigned made_in_ = process_generation();
  Lock lock_;
  std::unique_ptr<Batch> batch_;
};

}  // namespace racebeam::python
