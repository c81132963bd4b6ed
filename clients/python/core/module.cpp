// The module racebeam._core.
#include <nanobind/nanobind.h>

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

}  // namespace

NB_MODULE(_core, m) {
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
