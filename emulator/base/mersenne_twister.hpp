// std::mt19937 with words of 32 bits: the same numbers in half the memory, because the library's words have
// 64 bits.
#pragma once

#include <cstdint>
#include <random>

namespace racebeam {

using MersenneTwister =
    std::mersenne_twister_engine<std::uint32_t, 32, 624, 397, 31, 0x9908B0DF, 11, 0xFFFFFFFF, 7, 0x9D2C5680,
                                 15, 0xEFC60000, 18, 1812433253>;

}  // namespace racebeam
