// The area average with AVX2.
#include <immintrin.h>

#include "environment/observe/area_resize_rows.hpp"

#if RACEBEAM_HAS_AVX

namespace racebeam {

[[gnu::target("avx2")]] void AreaResize::reduce_avx2(const std::uint8_t* row, float* to) const {
  for (const Octet& octet : octets_) {
    const __m256i cells = _mm256_loadu2_m128i(reinterpret_cast<const __m128i*>(row + octet.from[1]),
                                              reinterpret_cast<const __m128i*>(row + octet.from[0]));
    __m256 sum = _mm256_setzero_ps();
    for (std::size_t tap = 0; tap < octet.places.size(); ++tap) {
      const __m256i places = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(octet.places[tap].data()));
      const __m256 cell = _mm256_cvtepi32_ps(_mm256_shuffle_epi8(cells, places));
      sum = _mm256_add_ps(sum, _mm256_mul_ps(cell, _mm256_loadu_ps(octet.weights[tap].data())));
    }
    _mm256_storeu_ps(to, sum);
    to += 8;
  }
}

[[gnu::target("avx2")]] void AreaResize::run_avx2(const std::uint8_t* in, std::uint8_t* out,
                                                  std::span<const std::uint8_t> rows) const {
  run(in, out, rows, [this](const std::uint8_t* row, float* to) { reduce_avx2(row, to); });
}
}  // namespace racebeam

#endif
