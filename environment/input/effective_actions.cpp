#include "environment/input/effective_actions.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

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

LegalActions::LegalActions(const std::vector<int>& legal, bool paddles) : paddles_(paddles) {
  for (const int action : legal) legal_ |= 1u << action;
}

void LegalActions::check(const Presses& presses) const {
  if (!std::isfinite(presses.a.strength) || !std::isfinite(presses.b.strength)) {
    throw std::invalid_argument("a paddle's strength must be a finite number");
  }
  if (paddles_) return;
  if (replace_a(presses.a.action) >= kConsoleActions) {
    throw std::invalid_argument(
        "action " + std::to_string(presses.a.action) +
        " of player A is out of range; accepted: 0 to 25, and 40 which presses nothing");
  }
  if (replace_b(presses.b.action) >= 36) {
    throw std::invalid_argument(
        "action " + std::to_string(presses.b.action) +
        " of player B is out of range; accepted: 18 to 35, and 40 which presses nothing");
  }
}

}  // namespace racebeam
