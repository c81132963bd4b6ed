#include "environment/observe/brightness.hpp"

#include "environment/observe/brightness_plain.hpp"

namespace racebeam {

Brightness::Brightness(const BrightnessTable& table, [[maybe_unused]] Simd form)
    : table_(&table), make_(Plain::make<1>), make_brighter_(Plain::make<2>) {
  if constexpr (kHasAvx) {
    if (form >= Simd::kAvx2) use_x86(form);
  }
  if constexpr (kHasNeon) {
    if (form == Simd::kNeon) use_neon();
  }
}

}  // namespace racebeam
