// Makes the masks of a line's six objects from the registers (docs/spec/tia.md, 7).
#pragma once

#include <array>
#include <cstdint>

#include "emulator/base/inlining.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/line/pixel_mask.hpp"

namespace racebeam {

enum Object : unsigned { kP0, kP1, kM0, kM1, kBall, kPlayfield, kObjects };

constexpr std::uint8_t object_bit(unsigned object) { return static_cast<std::uint8_t>(1U << object); }

// The 20 bits of PF0, PF1, PF2 in the order of the screen: bit 0 is the leftmost.
std::uint32_t playfield_bits(const TiaState& tia);

// Objects that are enabled, at any position: graphics not zero, ENAxx set, RESMPx clear (bit n: Object n).
inline std::uint8_t shown_graphics(const PlayerState& player) {  // before REFPx
  return player.vdel ? player.old_grp : player.grp;
}
inline bool missile_enabled(const MissileState& missile) { return missile.enabled && !missile.locked; }
inline bool ball_enabled(const BallState& ball) { return (ball.vdel ? ball.old_enabled : ball.enabled) != 0; }

inline bool playfield_enabled(const TiaRegisters& tia) {
  return ((tia.pf[0] & 0xF0) | tia.pf[1] | tia.pf[2]) != 0;
}

// The pixels of PF0, PF1 or PF2 in each half of a line: [first, end).
struct PlayfieldPart {
  int left, left_end, right, right_end;
};
constexpr PlayfieldPart kPlayfieldParts[2][3] = {
    {{0, 16, 80, 96}, {16, 48, 96, 128}, {48, 80, 128, 160}},
    {{0, 16, 144, 160}, {16, 48, 112, 144}, {48, 80, 80, 112}}};  // reflected

// Returns which of `objects` are enabled.
RACEBEAM_INLINE std::uint8_t enabled_among(const TiaRegisters& tia, unsigned objects) {
  unsigned found = 0;
  const auto look = [&](unsigned object, bool enabled) { found |= (enabled ? 1U : 0U) << object; };
  for (unsigned i = 0; i < 2; ++i) {
    if (objects >> (kP0 + i) & 1) look(kP0 + i, shown_graphics(tia.player[i]) != 0);
    if (objects >> (kM0 + i) & 1) look(kM0 + i, missile_enabled(tia.missile[i]));
  }
  if (objects >> kBall & 1) look(kBall, ball_enabled(tia.ball));
  if (objects >> kPlayfield & 1) look(kPlayfield, playfield_enabled(tia));
  return static_cast<std::uint8_t>(found);
}

constexpr unsigned kAllObjects = (1U << kObjects) - 1;
std::uint8_t enabled_objects(const TiaRegisters& tia);  // TiaRegisters::enabled, computed again

// The pixels that an object covers. The mask is written in place, word by word, as it is read later. A copy
// of the whole mask would wait until its words have left the processor's store buffer.
void draw_playfield(PixelMask& mask, const TiaState& tia);
void draw_player(PixelMask& mask, const PlayerState& player);
void draw_missile(PixelMask& mask, const TiaState& tia, unsigned which);
void draw_ball(PixelMask& mask, const TiaState& tia);

// The pixels of an object with all graphics bits set (docs/spec/tia.md, "Provisional pixels").
PixelMask player_shape(const PlayerState& player);

// Offsets of the copies that bits 0-2 of NUSIZx select; unused elements repeat offset 0.
struct Copies {
  unsigned count;
  std::array<std::uint8_t, 3> offset;
  unsigned scale;  // width of a player's pixel
};
extern const std::array<Copies, 8> kCopies;

}  // namespace racebeam
