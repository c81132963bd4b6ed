#include "clients/python/core/lock.hpp"

#include <pthread.h>

#include <stdexcept>

namespace racebeam::python {
namespace {

std::atomic<unsigned> generation{1};

[[maybe_unused]] const int forks_are_counted = pthread_atfork(nullptr, nullptr, [] { ++generation; });

}  // namespace

unsigned process_generation() { return generation; }

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
