// Selects the variant of a vectorised function for this processor.
#pragma once

// Zig's library does not tell what the processor has (platforms/macos.cmake, platforms/musl.cmake).
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__)) && !defined(__APPLE__) && \
    !defined(RACEBEAM_WITHOUT_AVX)
#define RACEBEAM_HAS_AVX 1
#else
#define RACEBEAM_HAS_AVX 0
#endif

namespace racebeam {

enum class Simd { kPlain, kAvx2, kAvx512 };  // kAvx512: with byte masks (AVX512BW)

// The best variant that the processor supports. The environment variable RACEBEAM_SIMD (plain, avx2, avx512)
// limits it. Determined once per process.
Simd simd();

// Returns the best kind of this processor, without the limit.
Simd best_simd();

}  // namespace racebeam
