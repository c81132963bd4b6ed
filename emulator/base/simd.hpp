// Selects the variant of a vectorised function for this processor.
#pragma once

#include <span>

// Zig's library does not report the features of the processor (platforms/macos.cmake, platforms/musl.cmake).
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__)) && !defined(__APPLE__) && \
    !defined(RACEBEAM_WITHOUT_AVX)
#define RACEBEAM_HAS_AVX 1
#else
#define RACEBEAM_HAS_AVX 0
#endif

namespace racebeam {

// Whether this program has variants for AVX2 and AVX-512, in sources NAME_x86.cpp, or for NEON, in sources
// NAME_neon.cpp.
inline constexpr bool kHasAvx = RACEBEAM_HAS_AVX;
#if defined(__aarch64__)
inline constexpr bool kHasNeon = true;
#else
inline constexpr bool kHasNeon = false;
#endif

enum class Simd { kPlain, kNeon, kAvx2, kAvx512 };  // kAvx512: with byte masks (AVX512BW)

// The best variant that the processor supports. The environment variable RACEBEAM_SIMD (plain, neon, avx2,
// avx512) limits it: variants after that in the list are not used. Determined once per process.
Simd simd();

// Returns what this processor supports, without the limit: kPlain first, the best last.
std::span<const Simd> supported_simd();

// Whether the processor also permutes bytes of 512 bits (AVX512_VBMI).
bool has_vbmi();

}  // namespace racebeam
