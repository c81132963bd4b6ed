#include "emulator/tia/line/line.hpp"

#include <bit>

#include "emulator/state/register_vectors.hpp"
#include "emulator/state/tia_bytes.hpp"

namespace racebeam {
namespace {

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

constexpr auto make_possible() {
  std::array<Collisions, 64> table{};
  for (unsigned objects = 0; objects < 64; ++objects)
    for (const Pair& p : kPairs)
      if ((objects & object_bit(p.a)) && (objects & object_bit(p.b))) table[objects] |= p.latch;
  return table;
}
static_assert(make_possible().back() == kAllPairs);

// The pairs with an object of each set.
constexpr auto make_pairs_of() {
  std::array<Collisions, 64> table{};
  for (unsigned objects = 0; objects < 64; ++objects)
    for (const Pair& p : kPairs)
      if (objects & (object_bit(p.a) | object_bit(p.b))) table[objects] |= p.latch;
  return table;
}
constexpr auto kPairsOf = make_pairs_of();

// kPairs by the number of the latch's bit. Bit 12, D6 of CXBLPF, is unused.
constexpr auto make_pair_of_latch() {
  std::array<Pair, 16> table{};
  for (const Pair& p : kPairs) table[static_cast<std::size_t>(std::countr_zero(p.latch))] = p;
  return table;
}
constexpr auto kPairOfLatch = make_pair_of_latch();

// Returns the pairs among these that meet.
template <class Meets>
RACEBEAM_INLINE Collisions pairs_among(Collisions pairs, const Meets& meets) {
  Collisions found = 0;
  for (unsigned rest = pairs; rest != 0; rest &= rest - 1) {
    const Pair& pair = kPairOfLatch[static_cast<std::size_t>(std::countr_zero(rest))];
    if (meets(pair)) found |= pair.latch;
  }
  return found;
}

// The bytes that a mask is made from, by Object.
constexpr std::array<ByteSet, kObjects> kShapeBytes = {
    RACEBEAM_TIA_BYTE_SET((p0.grp, p0.old_grp, p0.refp, p0.vdel, p0.nusiz, p0.position, p0.skip)),
    RACEBEAM_TIA_BYTE_SET((p1.grp, p1.old_grp, p1.refp, p1.vdel, p1.nusiz, p1.position, p1.skip)),
    RACEBEAM_TIA_BYTE_SET((m0.enabled, m0.locked, m0.position, p0.nusiz, cosmic_shape)),
    RACEBEAM_TIA_BYTE_SET((m1.enabled, m1.locked, m1.position, p1.nusiz)),
    RACEBEAM_TIA_BYTE_SET((ball.enabled, ball.old_enabled, ball.vdel, ball.position, ctrlpf)),
    RACEBEAM_TIA_BYTE_SET((pf[0], pf[1], pf[2], reflect))};

}  // namespace

std::uint8_t Line::outdated(const TiaRegisters& tia) const {
  const ByteSet changed = RegisterVectors(tia).bytes_other_than(RegisterVectors(shown));
  unsigned objects = 0;
  for (unsigned object = 0; object < kObjects; ++object)
    if ((changed & kShapeBytes[object]) != 0) objects |= object_bit(static_cast<Object>(object));
  return static_cast<std::uint8_t>(objects);
}

void Line::refresh(const TiaState& tia, std::uint8_t objects) {
  if (objects & object_bit(kP0)) draw_player(mask[kP0], tia.player[0]);
  if (objects & object_bit(kP1)) draw_player(mask[kP1], tia.player[1]);
  if (objects & object_bit(kM0)) draw_missile(mask[kM0], tia, 0);
  if (objects & object_bit(kM1)) draw_missile(mask[kM1], tia, 1);
  if (objects & object_bit(kBall)) draw_ball(mask[kBall], tia);
  if (objects & object_bit(kPlayfield)) draw_playfield(mask[kPlayfield], tia);
  const Collisions changed = kPairsOf[objects & kAllObjects];
  overlaps = static_cast<Collisions>(overlaps & ~changed);
  const auto possible = static_cast<Collisions>(kPossibleMeetings[tia.enabled] & changed);
  overlaps |= pairs_among(possible, [this](const Pair& p) { return mask[p.a].meets(mask[p.b]); });
}

constinit const std::array<Collisions, 64> kPossibleMeetings = make_possible();

std::uint8_t objects_of(Collisions pairs) {
  unsigned objects = 0;
  for (unsigned rest = pairs & kAllPairs; rest != 0; rest &= rest - 1) {
    const Pair& p = kPairOfLatch[static_cast<std::size_t>(std::countr_zero(rest))];
    objects |= object_bit(p.a) | object_bit(p.b);
  }
  return static_cast<std::uint8_t>(objects);
}

Collisions meetings(const Line& line, int first, int last, Collisions pairs) {
  if (pairs == 0) return 0;
  const PixelMask clip = PixelMask::range(first, last);
  return pairs_among(pairs, [&](const Pair& p) { return (line.mask[p.a] & clip).meets(line.mask[p.b]); });
}

}  // namespace racebeam
