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

NB_MODULE(_core_unchecked, m) {
  m.doc() = "racebeam's machine in this process. Use the package racebeam, which is built on it.";
  nb::set_leak_warnings(false);  // threads may hold objects when Python ends
  bind_errors(m);
  racebeam::python::bind_enumerations(m);
  racebeam::python::bind_catalogue(m);
  racebeam::python::bind_state(m);
  racebeam::python::bind_interface(m);
  racebeam::python::bind_vector_settings(m);
  racebeam::python::bind_vector(m);
  racebeam::python::bind_xla(m);
}

namespace {

// Python runs this in the interpreter that imports the module. The types of nanobind belong to the whole
// process, and a second interpreter that registers them would take them from the first. So the module refuses
// sub-interpreters. NumPy does not support sub-interpreters either.
int fill_module(PyObject* module) {
  constexpr auto kMainInterpreter = 0;
  if (PyInterpreterState_GetID(PyInterpreterState_Get()) == kMainInterpreter)
    return nanobind__core_unchecked_exec(module);
  PyErr_SetString(
      PyExc_ImportError,
      "racebeam was imported in a sub-interpreter, and it works only in the main interpreter of a "
      "process; import it there, or in another process");
  return -1;
}

}  // namespace

// Python 3.13 calls this in the main interpreter, whichever interpreter imports the module.
extern "C" NB_EXPORT PyObject* PyInit__core() {
  PyObject* const definition = PyInit__core_unchecked();
  if (definition == nullptr) return nullptr;
  PyModuleDef_Slot* slot = reinterpret_cast<PyModuleDef*>(definition)->m_slots;
  while (slot->slot != Py_mod_exec) ++slot;
  slot->value = reinterpret_cast<void*>(fill_module);
  return definition;
}
