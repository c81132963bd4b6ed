#include "environment/simd.hpp"

#include <cstdlib>
#include <string_view>

namespace racebeam {
namespace {

Simd find_simd() {
#if RACEBEAM_HAS_AVX2
  const char* const limit = std::getenv("RACEBEAM_SIMD");
  if (limit != nullptr && std::string_view(limit) == "plain") return Simd::kPlain;
  if (__builtin_cpu_supports("avx2")) return Simd::kAvx2;
#endif
  return Simd::kPlain;
}

}  // namespace

Simd simd() {
  static const Simd found = find_simd();
  return found;
}

}  // namespace racebeam
