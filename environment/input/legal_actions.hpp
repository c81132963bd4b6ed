// The action numbers that a game accepts, and the replacement of others (docs/spec/environment.md, 1).
#pragma once

#include <cstdint>
#include <vector>

#include "environment/input/sticky_actions.hpp"

namespace racebeam {

class LegalActions {
 public:
  LegalActions(const std::vector<int>& legal, bool paddles);

  // Throws std::invalid_argument for actions that would abort the reference's process. With paddles, any
  // number is accepted.
  void check(const Presses& asked) const;

  // Replaces illegal actions, and RESET, by NOOP.
  Presses replace(const Presses& held) const {
    return {{replace_a(held.a.action), held.a.strength}, {replace_b(held.b.action), held.b.strength}};
  }

 private:
  bool is_legal(int a) const { return a >= 0 && a < 18 && (legal_ >> a & 1) != 0; }
  int replace_a(int a) const { return (a < 18 && !is_legal(a)) || a == 40 ? 0 : a; }
  int replace_b(int b) const { return (b < 40 && !(b >= 18 && is_legal(b - 18))) || b == 40 ? 18 : b; }

  std::uint32_t legal_ = 0;  // bit n: action n is legal
  bool paddles_;
};

}  // namespace racebeam
