// Releases the GIL for a while, and takes it for a while.
//
// Before Python 3.14, a thread that takes the GIL while Python ends is ended by unwinding. If a destructor or
// a function of nanobind is on its stack, that would end the whole process by abort(). Such a thread instead
// sleeps until the process is gone, as it does from Python 3.14 on.
#pragma once

#include <cxxabi.h>
#include <nanobind/nanobind.h>

#include <chrono>
#include <thread>

namespace racebeam::python {

#if defined(__GLIBCXX__)
using Unwinding = abi::__forced_unwind;
#else
struct Unwinding {};  // macOS ends a thread without unwinding
#endif

template <class Take>
void take_gil(const Take& take) noexcept {
  try {
    take();
  } catch (const Unwinding&) {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }
}

// During its lifetime, other threads of Python run.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  ~WithoutGil() {
    take_gil([this] { PyEval_RestoreThread(state_); });
  }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

// During its lifetime, this thread may use Python.
class WithGil {
 public:
  WithGil() {
    take_gil([this] { state_ = PyGILState_Ensure(); });
  }
  ~WithGil() { PyGILState_Release(state_); }
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;

 private:
  PyGILState_STATE state_{};
};

}  // namespace racebeam::python
