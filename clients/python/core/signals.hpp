// Signals, such as Ctrl-C, during a call that takes long.
#pragma once

#include <nanobind/nanobind.h>

#include "clients/python/core/gil.hpp"

namespace racebeam::python {

// Called without the GIL. Runs Python's signal handlers, and throws what they raise, such as
// KeyboardInterrupt. Does nothing on any thread but the main one.
inline void look_for_signals() {
  const WithGil python;
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

}  // namespace racebeam::python
