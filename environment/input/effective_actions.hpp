// Which of the two players' actions take effect: illegal ones are replaced, and sticky ones are repeated
// (docs/spec/environment.md, 1, 3 and 4).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "emulator/base/mersenne_twister.hpp"
#include "games/game/actions.hpp"

namespace racebeam {

struct Press {
  std::int32_t action;
  float strength;  // how far a paddle turns
};

struct Presses {
  Press a{0, 1.0F};
  Press b{18, 0.0F};
};

// The reference compares a draw u / 2^32 with the probability p, in double precision. Returns the smallest u
// that lets a new action through. p is a float that has been through a decimal text of six significant
// digits.
std::uint64_t sticky_threshold(float p);

class Sticky {
 public:
  explicit Sticky(float p) : threshold_(sticky_threshold(p)) {}

  // Makes two draws, A's first, whatever p is.
  void draw(MersenneTwister& random, const Presses& presses, Presses& held) const {
    if (random() >= threshold_) held.a = presses.a;
    if (random() >= threshold_) held.b = presses.b;
  }

 private:
  std::uint64_t threshold_;
};

// The action numbers that a game accepts, and the replacement of others.
class LegalActions {
 public:
  // The controllers are player A's and player B's.
  LegalActions(const std::vector<int>& legal, Controller a, Controller b);

  // Whether the machine has an action of that number. Numbers that it replaces are included.
  bool has_a(int a) const { return has(replace_a(a), kConsoleActions, more_a_); }
  bool has_b(int b) const { return has(replace_b(b) - kActions, kActions, more_b_); }

  // Throws std::invalid_argument for other actions, which would abort the reference's process unless it has
  // paddles, and for a strength that is not a finite number.
  void check(const Presses& presses) const;

  // Replaces illegal actions, and the reference's RESET, by NOOP.
  Presses replace(const Presses& held) const {
    return {{replace_a(held.a.action), held.a.strength}, {replace_b(held.b.action), held.b.strength}};
  }

 private:
  static bool has(int action, int end, const std::vector<int>& more) {
    return (action >= 0 && action < end) || std::ranges::find(more, action) != more.end();
  }
  bool is_legal(int a) const { return a >= 0 && a < 18 && (legal_ >> a & 1) != 0; }
  int replace_a(int a) const { return (a < 18 && !is_legal(a)) || a == kReferenceReset ? 0 : a; }
  int replace_b(int b) const {
    return (b < 40 && !(b >= 18 && is_legal(b - 18))) || b == kReferenceReset ? 18 : b;
  }

  std::uint32_t legal_ = 0;  // bit n: action n is legal
  bool paddles_;
  std::vector<int> more_a_, more_b_;  // of their controllers
};

}  // namespace racebeam
