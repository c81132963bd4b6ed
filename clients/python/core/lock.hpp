// A lock for each object that Python can reach, so that two threads that use one object at once take turns. A
// lock that another thread held when the process forked is refused in the child, since nothing would ever
// release it. A lock that this thread holds already is refused, too: a signal handler then uses the object in
// the middle of a call.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "clients/python/core/gil.hpp"

namespace racebeam::python {

// The generation of this process; a child has another one than its parent.
unsigned process_generation();

class Lock {
 public:
  // Throws std::runtime_error in a child process whose parent forked while another thread held the lock, and
  // when the calling thread holds it.
  void lock();
  void unlock();

 private:
  std::mutex mutex_;
  std::atomic<unsigned> owned_in_{0};     // the generation of the process that locked it last
  std::atomic<std::thread::id> owner_{};  // the thread that holds it, if one does
};

// During its lifetime, which is that of one call, other threads of Python run, and this thread holds the lock
// of the object.
class Turn {
 public:
  explicit Turn(Lock& lock) : held_(lock) {}

 private:
  WithoutGil other_threads_run_;
  std::scoped_lock<Lock> held_;
};

}  // namespace racebeam::python
