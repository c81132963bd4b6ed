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

LegalActions::LegalActions(const std::vector<int>& legal, Controller a, Controller b)
    : paddles_(a == Controller::kPaddles || b == Controller::kPaddles),
      more_a_(actions_with(a)),
      more_b_(actions_with(b)) {
  for (const int action : legal) legal_ |= 1u << action;
}

void LegalActions::check(const Presses& presses) const {
  for (const float strength : {presses.a.strength, presses.b.strength}) {
    if (std::isfinite(strength)) continue;
    throw std::invalid_argument("a paddle's strength is " + std::to_string(strength) +
                                "; it must be a finite number");
  }
  const auto refuse = [](int action, const char* player, const char* accepted, bool has_more) {
    throw std::invalid_argument("action " + std::to_string(action) + " of player " + player +
                                " is out of range; accepted: " + accepted + ", and 40 which presses nothing" +
                                (has_more ? "; and those of its controller" : ""));
  };
  if (paddles_) return;
  if (!has_a(presses.a.action)) refuse(presses.a.action, "A", "0 to 25", !more_a_.empty());
  if (!has_b(presses.b.action)) refuse(presses.b.action, "B", "18 to 35", !more_b_.empty());
}

}  // namespace racebeam
