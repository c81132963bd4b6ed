#include "emulator/base/simd.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

namespace racebeam {
namespace {

constexpr std::array<std::pair<std::string_view, Simd>, 4> kNames = {
    {{"plain", Simd::kPlain}, {"neon", Simd::kNeon}, {"avx2", Simd::kAvx2}, {"avx512", Simd::kAvx512}}};

Simd limit() {
  const char* const value = std::getenv("RACEBEAM_SIMD");
  for (const auto& [name, form] : kNames)
    if (value != nullptr && value == name) return form;
  return Simd::kAvx512;
}

std::vector<Simd> find_supported() {
  std::vector<Simd> found = {Simd::kPlain};
  if (kHasNeon) found.push_back(Simd::kNeon);  // every AArch64 has it
#if RACEBEAM_HAS_AVX
  if (__builtin_cpu_supports("avx2")) found.push_back(Simd::kAvx2);
  if (__builtin_cpu_supports("avx512bw")) found.push_back(Simd::kAvx512);
#endif
  return found;
}

}  // namespace

std::span<const Simd> supported_simd() {
  static const std::vector<Simd> found = find_supported();
  return found;
}

Simd simd() {
  static const Simd found = [] {
    const auto all = supported_simd();
    return *(std::ranges::upper_bound(all, limit()) - 1);  // kPlain is never above the limit
  }();
  return found;
}

bool has_vbmi() {
#if RACEBEAM_HAS_AVX
  return supported_simd().back() == Simd::kAvx512 && __builtin_cpu_supports("avx512vbmi") != 0;
#else
  return false;
#endif
}

}  // namespace racebeam
