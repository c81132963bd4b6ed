#include "environment/input/sticky_actions.hpp"

#include <charconv>
#include <cmath>

namespace racebeam {
namespace {

float through_text(float p) {
  char text[32];
  const char* end = std::to_chars(text, text + sizeof text, p, std::chars_format::general, 6).ptr;
  std::from_chars(text, end, p);
  return p;
}

}  // namespace

std::uint64_t sticky_threshold(float p) {
  constexpr double kDraws = 4294967296.0;
  const double draws = std::ceil(kDraws * through_text(p));  // exact: a product with a power of two
  return draws <= 0 ? 0 : draws >= kDraws ? 1ULL << 32 : static_cast<std::uint64_t>(draws);
}

}  // namespace racebeam
