#include "emulator/line.hpp"

#include <bit>
#include <cstring>

namespace racebeam {
namespace {

constexpr std::uint8_t kScoreMode = 2, kPriorityMode = 4;  // bits of CTRLPF

constexpr std::uint8_t bit(Object object) { return static_cast<std::uint8_t>(1U << object); }

struct Pair {
  Object a, b;
  Collisions latch;
};

constexpr Pair pair(Object a, Object b, unsigned reg, unsigned data_bit) {
  return {a, b, static_cast<Collisions>(1U << (2 * reg + (data_bit - 6)))};
}

constexpr std::array<Pair, 15> kPairs = {{
    pair(kM0, kP1, 0, 7), pair(kM0, kP0, 0, 6),           // CXM0P
    pair(kM1, kP0, 1, 7), pair(kM1, kP1, 1, 6),           // CXM1P
    pair(kP0, kPlayfield, 2, 7), pair(kP0, kBall, 2, 6),  // CXP0FB
    pair(kP1, kPlayfield, 3, 7), pair(kP1, kBall, 3, 6),  // CXP1FB
    pair(kM0, kPlayfield, 4, 7), pair(kM0, kBall, 4, 6),  // CXM0FB
    pair(kM1, kPlayfield, 5, 7), pair(kM1, kBall, 5, 6),  // CXM1FB
    pair(kBall, kPlayfield, 6, 7),                        // CXBLPF
    pair(kP0, kP1, 7, 7), pair(kM0, kM1, 7, 6),           // CXPPMM
}};

constexpr PixelMask kLeftHalf = {{~std::uint64_t{0}, 0xFFFF, 0}};
constexpr PixelMask kRightHalf = {{0, ~std::uint64_t{0xFFFF}, 0xFFFFFFFF}};

// Three layers make every priority mode.
void set_layers(Line& line, const TiaRegisters& tia) {
  const std::uint8_t ctrlpf = tia.ctrlpf;
  const auto& m = line.mask;
  line.layers = 0;
  const auto add = [&line](const PixelMask& mask, Color color) {
    if (mask.any()) line.layer[line.layers++] = {mask, color};
  };
  const PixelMask &playfield = m[kPlayfield], &ball = m[kBall];
  const bool score = (ctrlpf & kScoreMode) != 0;
  if (score && !(ctrlpf & kPriorityMode)) {
    add(ball, kColupf);
    add(m[kP1] | m[kM1] | (playfield & kRightHalf), kColup1);
    add(m[kP0] | m[kM0] | (playfield & kLeftHalf), kColup0);
  } else if (score && tia.enabled == bit(kPlayfield)) {
    add(playfield & kRightHalf, kColup1);
    add(playfield & kLeftHalf, kColup0);
  } else {
    const bool in_front = (ctrlpf & kPriorityMode) != 0;
    if (!in_front) add(playfield | ball, kColupf);
    add(m[kP1] | m[kM1], kColup1);
    add(m[kP0] | m[kM0], kColup0);
    if (in_front) add(playfield | ball, kColupf);
  }
}

// For each set of covered objects, the latches that they can set.
constexpr auto make_possible() {
  std::array<Collisions, 64> table{};
  for (unsigned objects = 0; objects < 64; ++objects)
    for (const Pair& p : kPairs)
      if ((objects & bit(p.a)) && (objects & bit(p.b))) table[objects] |= p.latch;
  return table;
}
constexpr auto kPossible = make_possible();

// kPairs by the number of the latch's bit. (Bit 12, D6 of CXBLPF, is nobody's.)
constexpr auto make_pair_of_latch() {
  std::array<Pair, 16> table{};
  for (const Pair& p : kPairs) table[static_cast<std::size_t>(std::countr_zero(p.latch))] = p;
  return table;
}
constexpr auto kPairOfLatch = make_pair_of_latch();

}  // namespace

std::uint8_t Line::outdated(const TiaRegisters& tia) const {
  const auto differ = [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) != 0; };
  unsigned objects = 0;
  for (unsigned i = 0; i < 2; ++i) {
    if (differ(tia.player[i], shown.player[i])) objects |= 1U << (kP0 + i) | 1U << (kM0 + i);  // NUSIZx is both's
    if (differ(tia.missile[i], shown.missile[i])) objects |= 1U << (kM0 + i);
  }
  if (tia.cosmic_shape != shown.cosmic_shape) objects |= bit(kM0);
  if (differ(tia.ball, shown.ball)) objects |= bit(kBall);
  if (differ(tia.pf, shown.pf) || tia.reflect != shown.reflect) objects |= bit(kPlayfield);
  if (tia.ctrlpf != shown.ctrlpf) objects |= bit(kBall) | bit(kPlayfield);
  return static_cast<std::uint8_t>(objects);
}

void Line::refresh(const TiaState& tia, std::uint8_t objects) {
  for (unsigned i = 0; i < 2; ++i) {
    if (objects >> (kP0 + i) & 1) draw_player(mask[kP0 + i], tia.player[i]);
    if (objects >> (kM0 + i) & 1) draw_missile(mask[kM0 + i], tia, i);
  }
  if (objects & bit(kBall)) draw_ball(mask[kBall], tia);
  if (objects & bit(kPlayfield)) draw_playfield(mask[kPlayfield], tia);
  covered = 0;
  for (unsigned i = 0; i < kObjects; ++i) covered |= static_cast<std::uint8_t>((mask[i].any() ? 1U : 0U) << i);
  set_layers(*this, tia);
  shown = tia;
}

bool can_meet(std::uint8_t objects, Collisions known) { return (kPossible[objects] & ~known) != 0; }

Collisions meetings(const Line& line, int first, int last, Collisions known) {
  unsigned left = kPossible[line.covered] & ~known;
  if (left == 0) return 0;
  const PixelMask clip = PixelMask::range(first, last);
  Collisions found = 0;
  for (; left != 0; left &= left - 1) {
    const Pair& p = kPairOfLatch[static_cast<std::size_t>(std::countr_zero(left))];
    if ((line.mask[p.a] & clip).meets(line.mask[p.b])) found |= p.latch;
  }
  return found;
}

}  // namespace racebeam
