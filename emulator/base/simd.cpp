#include "emulator/base/simd.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace racebeam {
namespace {

Simd limit() {
  const char* const value = std::getenv("RACEBEAM_SIMD");
  const std::string_view name = value != nullptr ? value : "";
  return name == "plain" ? Simd::kPlain : name == "avx2" ? Simd::kAvx2 : Simd::kAvx512;
}

}  // namespace

Simd best_simd() {
#if RACEBEAM_HAS_AVX
  if (__builtin_cpu_supports("avx512bw")) return Simd::kAvx512;
  if (__builtin_cpu_supports("avx2")) return Simd::kAvx2;
#endif
  return Simd::kPlain;
}

Simd simd() {
  static const Simd found = std::min(best_simd(), limit());
  return found;
}

}  // namespace racebeam
