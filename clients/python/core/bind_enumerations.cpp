#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "clients/python/core/ale_interface.hpp"
#include "clients/python/core/bindings.hpp"
#include "clients/python/core/python_action.hpp"
#include "games/game/property_overrides.hpp"

namespace racebeam::python {

namespace nb = nanobind;
using namespace nb::literals;

namespace {

std::vector<PythonControllerAction> controller_actions(std::string_view controller) {
  std::vector<PythonControllerAction> actions;
  for (const int number : actions_with(value_for(controller, "controller", kControllers)))
    actions.push_back(static_cast<PythonControllerAction>(number));
  return actions;
}

}  // namespace

void bind_enumerations(nb::module_& module) {
  nb::enum_<PythonAction> actions(module, "Action", "An action of player A.");
  for (const int number : all_actions()) {
    const std::string name(action_name(number));
    actions.value(name.c_str(), static_cast<PythonAction>(number));
  }
  nb::enum_<PythonConsoleAction> console(
      module, "ConsoleAction", "An action of player A that presses or moves a switch of the console.");
  for (int number = kActions; number < kConsoleActions; ++number) {
    const std::string name(action_name(number));
    console.value(name.c_str(), static_cast<PythonConsoleAction>(number));
  }
  nb::enum_<PythonControllerAction> controller(
      module, "ControllerAction",
      "An action that only some controllers have, as of player A; \"_\" is \"+\" in its name.");
  for (int number = kFirstKey; number < kActionNumbers; ++number) {
    std::string name(action_name(number));
    std::ranges::replace(name, '+', '_');
    if (!name.empty()) controller.value(name.c_str(), static_cast<PythonControllerAction>(number));
  }
  module.def("controller_actions", controller_actions, "controller"_a,
             "Lists the actions that only such a controller has. The names of controllers are those of the "
             "setting left.");
  nb::enum_<LoggerMode>(module, "LoggerMode", "The logger modes of ALE. racebeam logs nothing.")
      .value("Info", LoggerMode::kInfo)
      .value("Warning", LoggerMode::kWarning)
      .value("Error", LoggerMode::kError);
  nb::enum_<View>(module, "View", "What step() observes.")
      .value("RGB", View::kRgb, "height x 160 x 3")
      .value("GRAYSCALE", View::kGrey, "height x 160")
      .value("RAM", View::kRam, "128 bytes")
      .value("PALETTE", View::kPalette, "height x 160 numbers of colours")
      .value("NONE", View::kNone, "nothing");
}

}  // namespace racebeam::python
