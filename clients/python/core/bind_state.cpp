#include <nanobind/stl/string.h>

#include <functional>

#include "clients/python/core/ale_state.hpp"
#include "clients/python/core/bindings.hpp"

namespace racebeam::python {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

std::string text_of(const nb::bytes& bytes) { return {bytes.c_str(), bytes.size()}; }

nb::bytes serialize(const AleState& state) {
  const std::string bytes = state.serialize();
  return nb::bytes(bytes.data(), bytes.size());
}

}  // namespace

void bind_state(nb::module_& module) {
  nb::class_<AleState>(module, "ALEState", "A state of a game, with its picture and its sound.")
      .def(nb::init<>())
      .def(
          "__init__", [](AleState* self, const nb::bytes& bytes) { new (self) AleState(text_of(bytes)); },
          "serialized"_a)
      .def(
          "__init__",
          [](AleState* self, const AleState&, const nb::bytes& bytes) {
            new (self) AleState(text_of(bytes));
          },
          "state"_a, "serialized"_a)
      .def("serialize", serialize, "Returns the state as bytes, which another process can restore.")
      .def("equals", &AleState::equals, "other"_a)
      .def("__eq__", &AleState::equals, nb::is_operator(),
           nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__hash__", [](const AleState& self) { return std::hash<std::string>{}(self.serialize()); })
      .def("getFrameNumber", [](const AleState& self) { return self.facts().frame; })
      .def("getEpisodeFrameNumber", [](const AleState& self) { return self.facts().episode_frame; })
      .def("getDifficulty", [](const AleState& self) { return self.facts().difficulty; })
      .def("getCurrentMode", [](const AleState& self) { return self.facts().mode; })
      .def("__getstate__", serialize)
      .def("__setstate__",
           [](AleState& self, const nb::bytes& bytes) { new (&self) AleState(text_of(bytes)); });
}

}  // namespace racebeam::python
