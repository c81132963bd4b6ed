// Types that exist only for Python.
#pragma once

#include <cstdint>

#include "games/game/actions.hpp"

namespace racebeam::python {

enum class PythonAction : std::int32_t {};            // player A's numbers, as all_actions() lists them
enum class PythonConsoleAction : std::int32_t {};     // those after them, which press or move a switch
enum class PythonControllerAction : std::int32_t {};  // and those that only some controllers have

enum class LoggerMode { kInfo, kWarning, kError };

}  // namespace racebeam::python
