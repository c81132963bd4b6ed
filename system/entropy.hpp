// Numbers that nobody can predict.
#pragma once

#include <cstdint>

namespace racebeam {

std::uint32_t random_number();  // throws std::system_error

}  // namespace racebeam
