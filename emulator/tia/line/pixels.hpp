// Converts a line's layers to bytes of the picture: portable, with NEON, with AVX2, and with AVX-512.
#pragma once

#include <cstdint>

#include "emulator/base/simd.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/line/line.hpp"

namespace racebeam {

// Writes pixels [first, last) of a row, and no other byte. The row must be aligned to 32 bytes.
using DrawPixels = void (*)(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first,
                            int last);

DrawPixels pixel_drawer(Simd simd);  // `simd` must be supported by the processor

}  // namespace racebeam
