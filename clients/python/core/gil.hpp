// The GIL, given back for a while and taken for a while.
//
// While Python ends, a thread that takes the GIL is ended, by unwinding; before Python 3.14, that is. Where a
// destructor or a function of nanobind is in the way, that would end the whole process by abort(). Such a
// thread sleeps instead until the process is gone, as it does from Python 3.14 on.
#pragma once

#include <cxxabi.h>
#include <nanobind/nanobind.h>

#include <chrono>
#include <thread>

namespace racebeam::python {

#if defined(__GLIBCXX__)
using Unwinding = abi::__forced_unwind;
#else
struct Unwinding {};  // macOS ends a thread without
#endif

template <class Take>
void take_gil(const Take& take) noexcept {
  try {
    take();
  } catch (const Unwinding&) {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }
}

// Other threads of Python run as long as it lives.
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

// This thread may use Python as long as it lives.
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
