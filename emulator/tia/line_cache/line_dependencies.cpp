#include "emulator/tia/line_cache/line_dependencies.hpp"

#include "emulator/tia/line/objects.hpp"
#include "emulator/tia/registers/registers.hpp"
#include "emulator/tia/registers/write_log.hpp"

namespace racebeam {
namespace {

constexpr std::uint8_t bit(unsigned object) { return static_cast<std::uint8_t>(1U << object); }

constexpr bool draws(unsigned reg) {
  return reg <= CXCLR && !(reg >= AUDC0 && reg <= AUDV1) && reg != VSYNC && reg != WSYNC && reg != RSYNC;
}

// The most colour clocks between a write and its effect (docs/spec/tia.md, 4 and 8).
constexpr int longest_delay(unsigned reg) {
  if (reg == RESP0 || reg == RESP1) return 11;
  if (reg == NUSIZ0 || reg == NUSIZ1 || reg == RESM0 || reg == RESM1) return 8;
  return reg >= PF0 && reg <= PF2 ? 5 : 1;
}

// The first cycle in which a write belongs to the next line. Cycle 76 is clock 228: the line is drawn, but
// its end, which may undo these writes, is not processed. A write there is like one in the next line, except
// RESPx and what may start the Cosmic Ark mode. PFx waits for five clocks in cycle 75, for two in 74.
constexpr std::int8_t first_late(unsigned reg) {
  switch (reg) {
    case RESP0: case RESP1: case HMM0: case WriteLog::kNobody: return 127;
    case NUSIZ0: case NUSIZ1: case RESM0: case RESM1: return 74;
    case PF0: case PF1: case PF2: return 75;
    default: return 76;
  }
}

// VBLANK is part of every key. The effect of CTRLPF on the playfield's colours is recorded when it is drawn.
constexpr std::uint8_t control_of(unsigned reg) {
  switch (reg) {
    case GRP0: return bit(kP0) | bit(kP1);
    case GRP1: return bit(kP0) | bit(kP1) | bit(kBall);  // both move a value to where VDELxx shows it
    case VDELP0: return bit(kP0);
    case VDELP1: return bit(kP1);
    case RESP0: return kPlaceOfP0;
    case RESP1: return kPlaceOfP1;
    case ENAM0: return bit(kM0);
    case ENAM1: return bit(kM1);
    case RESMP0: return bit(kM0) | kPlaceOfP0;  // leaves the missile at its player's position
    case RESMP1: return bit(kM1) | kPlaceOfP1;
    case ENABL: case VDELBL: return bit(kBall);
    case PF0: case PF1: case PF2: return bit(kPlayfield);
    default: return 0;
  }
}

constexpr std::array<LineEffect, 64> make_effects() {
  std::array<LineEffect, 64> table{};
  for (unsigned reg = 0; reg < 64; ++reg) {
    const std::uint16_t seen = reg == HMOVE ? kMoves : reg == CXCLR ? kClears : 0;
    const int last_cycle = (228 - longest_delay(reg)) / 3;
    const bool never = reg == WriteLog::kNobody;
    table[reg] = {never ? 0 : TiaWrite(kEarliestWrite + last_cycle, 0x3F, 0xFF).packed(), first_late(reg), control_of(reg), seen};
  }
  return table;
}

constexpr std::uint64_t make_drawing_registers() {
  std::uint64_t registers = 0;
  for (unsigned reg = 0; reg < 64; ++reg)
    if (draws(reg)) registers |= std::uint64_t{1} << reg;
  return registers;
}

// The motions count where HMOVE moves an object that is shown. The cosmic counter counts for the end of a
// line.
constexpr TiaRegisters make_seen(unsigned seen) {
  const auto shown = [seen](unsigned bits) { return static_cast<std::uint8_t>(seen & bits ? 0xFF : 0); };
  const std::uint8_t moves = shown(kMoves), ball = shown(bit(kBall)), playfield = shown(bit(kPlayfield));
  TiaRegisters mask;
  for (unsigned i = 0; i < 2; ++i) {
    const std::uint8_t player = shown(bit(kP0 + i)), missile = shown(bit(kM0 + i)), either = player | missile;
    const std::uint8_t moved = player & moves;
    mask.player[i] = {player, player, player, player, either, player, moved, player};
    mask.missile[i] = {0, 0, missile, static_cast<std::uint8_t>(missile & moves)};
    mask.color[i] = either | shown(kScoreSeen);
  }
  mask.ball = {0, 0, 0, ball, static_cast<std::uint8_t>(ball & moves)};
  mask.color[2] = mask.ctrlpf = ball | playfield;
  mask.reflect = playfield;
  mask.pf = {playfield, playfield, playfield};
  mask.cosmic_shape = static_cast<CosmicShape>(shown(bit(kM0)));
  mask.vblank = 0xFF;
  mask.color[3] = mask.comb_armed = mask.enabled = shown(kLit);
  return mask;
}

constexpr TiaRegisters make_control(unsigned control) {
  const auto acted_on = [control](unsigned bits) { return static_cast<std::uint8_t>(control & bits ? 0xFF : 0); };
  const std::uint8_t ball = acted_on(bit(kBall)), playfield = acted_on(bit(kPlayfield));
  TiaRegisters mask;
  for (unsigned i = 0; i < 2; ++i) {
    const std::uint8_t player = acted_on(bit(kP0 + i)), missile = acted_on(bit(kM0 + i));
    const std::uint8_t place = acted_on(kPlaceOfP0 << i);
    mask.player[i] = {player, player, 0, player, place, place, place, 0};
    mask.missile[i] = {missile, missile, 0, 0};
  }
  mask.ball = {ball, ball, ball, 0, 0};
  mask.pf = {playfield, playfield, playfield};
  return mask;
}

template <std::size_t kSize>
constexpr std::array<TiaRegisters, kSize> make_bytes(TiaRegisters make(unsigned)) {
  std::array<TiaRegisters, kSize> table{};
  for (unsigned i = 0; i < kSize; ++i) table[i] = make(i);
  return table;
}

}  // namespace

constinit const std::uint64_t kDrawingRegisters = make_drawing_registers();
constinit const std::array<LineEffect, 64> kLineEffects = make_effects();
constinit const std::array<TiaRegisters, 512> kSeenBytes = make_bytes<512>(make_seen);
constinit const std::array<TiaRegisters, 256> kControlBytes = make_bytes<256>(make_control);

}  // namespace racebeam
