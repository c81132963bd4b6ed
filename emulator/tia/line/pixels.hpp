// A line's layers turned into bytes of the picture: for any processor, and with AVX2 and AVX-512.
#pragma once

#include <cstdint>

#include "emulator/base/simd.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/line/line.hpp"

namespace racebeam {

// Writes pixels `first` to `last` - 1 of a row that begins at a multiple of 32 bytes, and no other byte.
using DrawPixels = void (*)(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last);

DrawPixels pixel_drawer(Simd simd);  // one that the processor must be able to run

}  // namespace racebeam
