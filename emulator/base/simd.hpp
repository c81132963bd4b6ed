// Which form of a function that comes in several is to run on this processor.
#pragma once

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define RACEBEAM_HAS_AVX 1
#else
#define RACEBEAM_HAS_AVX 0
#endif

namespace racebeam {

enum class Simd { kPlain, kAvx2, kAvx512 };  // the last: with byte masks (AVX512BW)

// The best that the processor can do; the environment variable RACEBEAM_SIMD (plain, avx2, avx512) sets a limit to it.
// Found once; the same for the whole process.
Simd simd();

// Whatever the variable says.
Simd best_simd();

}  // namespace racebeam
