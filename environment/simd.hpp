// Which form of a function that comes in several is to run on this processor.
#pragma once

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define RACEBEAM_HAS_AVX2 1
#else
#define RACEBEAM_HAS_AVX2 0
#endif

namespace racebeam {

enum class Simd { kPlain, kAvx2 };

// The best that the processor can do; the environment variable RACEBEAM_SIMD (plain, avx2, avx512) sets a
// limit to it. Found once; the same for the whole process.
Simd simd();

}  // namespace racebeam
