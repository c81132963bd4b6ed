#include "emulator/tia/line_cache/line_dependencies.hpp"

#include <algorithm>

#include "emulator/tia/line/objects.hpp"
#include "emulator/tia/registers/register_bytes.hpp"
#include "emulator/tia/registers/registers.hpp"
#include "emulator/tia/registers/write_log.hpp"

namespace racebeam {
namespace {

// The bytes that decide whether an object is enabled, and for kPlaceOfP0 and kPlaceOfP1 those that place its
// copies.
constexpr TiaRegisters control_bytes(unsigned which) {
  switch (which) {
    case object_bit(kP0): return RACEBEAM_TIA_BYTES((p0.grp, p0.old_grp, p0.vdel));
    case object_bit(kP1): return RACEBEAM_TIA_BYTES((p1.grp, p1.old_grp, p1.vdel));
    case object_bit(kM0): return RACEBEAM_TIA_BYTES((m0.enabled, m0.locked));
    case object_bit(kM1): return RACEBEAM_TIA_BYTES((m1.enabled, m1.locked));
    case object_bit(kBall): return RACEBEAM_TIA_BYTES((ball.enabled, ball.old_enabled, ball.vdel));
    case object_bit(kPlayfield): return RACEBEAM_TIA_BYTES((pf[0], pf[1], pf[2]));
    case kPlaceOfP0: return RACEBEAM_TIA_BYTES((p0.nusiz, p0.position, p0.motion));
    case kPlaceOfP1: return RACEBEAM_TIA_BYTES((p1.nusiz, p1.position, p1.motion));
    default: return {};
  }
}

// The largest cycle of a line at which a write still takes effect on it, whatever its delay.
constexpr int last_cycle(unsigned reg) { return (228 - std::max(kRegisters[reg].delay, 1)) / 3; }

// The first cycle in which a write belongs to the next line. Cycle 76 is clock 228: the line is drawn, but
// its end, which may undo the write, is not processed. A write there is like one in the next line, where the
// row of the register says so.
constexpr std::int8_t first_late(unsigned reg) {
  const bool never = reg == kNone || kRegisters[reg].late == WhenLate::kOwn;
  return static_cast<std::int8_t>(never ? 127 : last_cycle(reg) + 1);
}

// A write affects the control of the objects whose control bytes it sets. RESPx and RESMPx read the positions
// of a player's copies. VBLANK is part of every key. The effect of CTRLPF on the playfield's colours is
// recorded when it is drawn.
constexpr std::uint8_t control_of(unsigned reg) {
  const RegisterBytes& bytes = kRegisterBytes[reg];
  unsigned control = 0;
  for (unsigned object = 0; object < kObjects; ++object)
    if (share_a_byte(bytes.sets, control_bytes(object_bit(object)))) control |= object_bit(object);
  if (share_a_byte(bytes.reads, RACEBEAM_TIA_BYTES((p0.nusiz)))) control |= kPlaceOfP0;
  if (share_a_byte(bytes.reads, RACEBEAM_TIA_BYTES((p1.nusiz)))) control |= kPlaceOfP1;
  return static_cast<std::uint8_t>(control);
}

constexpr std::array<LineEffect, 64> make_effects() {
  std::array<LineEffect, 64> table{};
  for (unsigned reg = 0; reg < 64; ++reg) {
    const std::uint16_t dependencies = reg == HMOVE                     ? kMoves
                                       : reg == CXCLR                   ? kClears
                                       : reg == HMM0                    ? kMayBeCosmic
                                       : reg >= COLUP0 && reg <= COLUBK ? kRecolors
                                                                        : 0;
    const std::uint32_t last =
        reg == kNone ? 0 : TiaWrite(kEarliestWrite + last_cycle(reg), 0x3F, 0xFF).packed();
    table[reg] = {last, first_late(reg), control_of(reg), dependencies};
  }
  return table;
}

// The bits of CTRLPF that matter where the ball is shown, its width and priority, or the playfield, its
// priority and the score's colours. A latch reflects the playfield.
constexpr std::uint8_t kBallControl = 0x34, kPlayfieldControl = 0x06;

// The motions count where HMOVE moves an object that is shown. The cosmic counter counts for the end of a
// line.
constexpr TiaRegisters make_seen(unsigned seen) {
  const auto byte_if = [seen](unsigned bits) { return static_cast<std::uint8_t>(seen & bits ? 0xFF : 0); };
  const std::uint8_t moves = byte_if(kMoves), ball = byte_if(object_bit(kBall)),
                     playfield = byte_if(object_bit(kPlayfield));
  TiaRegisters mask;
  for (unsigned i = 0; i < 2; ++i) {
    const std::uint8_t player = byte_if(object_bit(kP0 + i)), missile = byte_if(object_bit(kM0 + i)),
                       either = player | missile;
    const std::uint8_t moved = player & moves;
    mask.player[i] = {player, player, player, player, either, player, moved, player};
    mask.missile[i] = {0, 0, missile, static_cast<std::uint8_t>(missile & moves)};
    mask.color[i] = either | byte_if(kScoreSeen);
  }
  mask.ball = {0, 0, 0, ball, static_cast<std::uint8_t>(ball & moves)};
  mask.color[2] = ball | playfield;
  mask.ctrlpf = (ball & kBallControl) | (playfield & kPlayfieldControl);
  mask.reflect = playfield;
  mask.pf = {playfield, playfield, playfield};
  mask.cosmic_shape = static_cast<CosmicShape>(byte_if(object_bit(kM0)));
  mask.vblank = 0xFF;
  mask.color[3] = mask.comb_armed = mask.enabled = byte_if(kLit);
  return mask;
}

constexpr std::array<TiaRegisters, 512> make_all_seen() {
  std::array<TiaRegisters, 512> table{};
  for (unsigned seen = 0; seen < table.size(); ++seen) table[seen] = make_seen(seen);
  return table;
}

// Each row has one bit more than an earlier one.
constexpr std::array<TiaRegisters, 256> make_all_control() {
  std::array<TiaRegisters, 256> table{};
  for (unsigned control = 1; control < table.size(); ++control) {
    const unsigned fewer = control & (control - 1);
    table[control] = table[fewer] | control_bytes(control - fewer);
  }
  return table;
}

}  // namespace

constinit const std::array<LineEffect, 64> kLineEffects = make_effects();
constinit const std::array<TiaRegisters, 512> kSeenBytes = make_all_seen();
constinit const std::array<TiaRegisters, 256> kControlBytes = make_all_control();

}  // namespace racebeam
