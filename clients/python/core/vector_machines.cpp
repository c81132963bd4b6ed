#include "clients/python/core/vector_machines.hpp"

#include <stdexcept>

namespace racebeam::python {

// A child process does not free the batch: it cannot wait for threads that it does not have.
SharedBatch::~SharedBatch() {
  if (is_forked()) static_cast<void>(batch_.release());
}

Batch& SharedBatch::batch(InterruptCheck interrupt_check) {
  if (is_forked())
    throw std::runtime_error("these environments were made before the process forked; make new ones");
  batch_->set_interrupt_check(interrupt_check);
  return *batch_;
}

}  // namespace racebeam::python
