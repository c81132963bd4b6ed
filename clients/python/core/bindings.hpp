// The parts of the module: a function for each file bind_*.cpp, in the order in which they need each
// other.
#pragma once

#include <nanobind/nanobind.h>

namespace racebeam::python {

class AleInterface;

void bind_enumerations(nanobind::module_& module);  // Action, LoggerMode, View
void bind_catalogue(nanobind::module_& module);     // games and images
void bind_state(nanobind::module_& module);         // ALEState
void bind_interface(nanobind::module_& module);     // ALEInterface
void bind_pickling(nanobind::class_<AleInterface>& interface);
void bind_vector_settings(nanobind::module_& module);  // VectorSettings
void bind_vector(nanobind::module_& module);           // VectorMachines
void bind_xla(nanobind::module_& module);              // its custom calls of XLA

}  // namespace racebeam::python
