#include "clients/python/core/lock.hpp"

#include <pthread.h>

#include <stdexcept>

namespace racebeam::python {
namespace {

std::atomic<unsigned> generation{1};  // of this process; a child has another than its parent

[[maybe_unused]] const int forks_are_counted = pthread_atfork(nullptr, nullptr, [] { ++generation; });

}  // namespace

void Lock::lock() {
  if (!mutex_.try_lock()) {
    if (owned_in_ != generation)
      throw std::runtime_error(
          "this object was in use by another thread when the process forked; make a new one");
    mutex_.lock();
  }
  owned_in_ = generation.load();
}

}  // namespace racebeam::python
