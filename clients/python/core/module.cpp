// The module racebeam._core.
#include <nanobind/nanobind.h>

#include <atomic>
#include <cstdint>

#include "clients/python/core/bindings.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

// Bad input is a RuntimeError, as it is in ALE, and a ValueError, as it is in Python.
void bind_errors(nb::module_& m) {
  const nb::tuple bases = nb::make_tuple(nb::borrow(PyExc_RuntimeError), nb::borrow(PyExc_ValueError));
  nb::exception<racebeam::InvalidInput>(m, "InvalidInput", bases);
}

// The types of nanobind belong to the whole process: a second interpreter that registers them takes them from
// the first. The first interpreter that asks gets the module; the number of an interpreter is never used
// again.
bool is_first_interpreter() {
  constexpr std::int64_t kNone = -1;
  static std::atomic<std::int64_t> first = kNone;
  const std::int64_t own = PyInterpreterState_GetID(PyInterpreterState_Get());
  std::int64_t found = kNone;
  return first.compare_exchange_strong(found, own) || found == own;
}

}  // namespace

NB_MODULE(_core_of_first, m) {
  m.doc() = "racebeam's machine in this process. Use the package racebeam, which is built on it.";
  nb::set_leak_warnings(false);  // what threads hold when Python ends is no leak
  bind_errors(m);
  racebeam::python::bind_enumerations(m);
  racebeam::python::bind_catalogue(m);
  racebeam::python::bind_state(m);
  racebeam::python::bind_interface(m);
  racebeam::python::bind_vector_settings(m);
  racebeam::python::bind_vector(m);
  racebeam::python::bind_xla(m);
}

// Nothing is registered before the check.
extern "C" NB_EXPORT PyObject* PyInit__core() {
  if (is_first_interpreter()) return PyInit__core_of_first();
  PyErr_SetString(PyExc_ImportError,
                  "another interpreter of this process has imported racebeam, and its objects work in one "
                  "interpreter only; import it in the same interpreter, or in another process");
  return nullptr;
}
