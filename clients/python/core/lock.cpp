#include "clients/python/core/lock.hpp"

#include <stdexcept>

#include "system/forks.hpp"

namespace racebeam::python {
namespace {

std::atomic<unsigned> generation{1};

[[maybe_unused]] const bool forks_are_counted = (call_in_forked_children([] { ++generation; }), true);

}  // namespace

unsigned process_generation() { return generation; }

void Lock::lock() {
  if (!mutex_.try_lock()) {
    if (owned_in_ != generation)
      throw std::runtime_error(
          "this object was in use by another thread when the process forked; make a new one");
    if (owner_ == std::this_thread::get_id())
      throw std::runtime_error(
          "this object is in use by the call that was interrupted; a signal handler cannot use it");
    mutex_.lock();
  }
  owned_in_ = generation.load();
  owner_ = std::this_thread::get_id();
}

void Lock::unlock() {
  owner_ = std::thread::id();
  mutex_.unlock();
}

}  // namespace racebeam::python
