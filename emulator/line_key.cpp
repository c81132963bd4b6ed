#include "emulator/line_key.hpp"

#include "emulator/objects.hpp"
#include "emulator/registers.hpp"

namespace racebeam {
namespace {

constexpr std::uint8_t bit(unsigned object) { return static_cast<std::uint8_t>(1U << object); }

constexpr bool draws(unsigned reg) {
  return reg <= CXCLR && !(reg >= AUDC0 && reg <= AUDV1) && reg != VSYNC && reg != WSYNC && reg != RSYNC;
}

// The most colour clocks between a write and its effect (tia.md, sections 4 and 8).
constexpr int longest_delay(unsigned reg) {
  if (reg == RESP0 || reg == RESP1) return 11;
  if (reg == NUSIZ0 || reg == NUSIZ1 || reg == RESM0 || reg == RESM1) return 8;
  return reg >= PF0 && reg <= PF2 ? 5 : 1;
}

constexpr std::uint8_t involved_by(unsigned reg) {
  switch (reg) {
    case GRP0: return bit(kP0) | bit(kP1);
    case GRP1: return bit(kP0) | bit(kP1) | bit(kBall);  // both move something to where VDELxx shows it
    case VDELP0: return bit(kP0);
    case VDELP1: return bit(kP1);
    case ENAM0: return bit(kM0);
    case ENAM1: return bit(kM1);
    case RESMP0: return bit(kM0) | bit(kP0);
    case RESMP1: return bit(kM1) | bit(kP1);
    case ENABL: case VDELBL: return bit(kBall);
    case PF0: case PF1: case PF2: return bit(kPlayfield);
    case HMOVE: return kMovesObjects;
    case VBLANK: return kBlanks;
    default: return 0;
  }
}

constexpr std::array<LineEffect, 64> make_effects() {
  std::array<LineEffect, 64> table{};
  for (unsigned reg = 0; reg < 64; ++reg)
    table[reg] = {draws(reg), static_cast<std::int8_t>((228 - longest_delay(reg)) / 3), involved_by(reg)};
  return table;
}

std::uint8_t enabled_objects(const TiaRegisters& r) {
  std::uint8_t objects = ball_enabled(r.ball) ? bit(kBall) : 0;
  for (unsigned i = 0; i < 2; ++i) {
    if (shown_graphics(r.player[i]) != 0) objects |= bit(kP0 + i);
    if (missile_enabled(r.missile[i])) objects |= bit(kM0 + i);
  }
  if ((r.pf[0] & 0xF0) | r.pf[1] | r.pf[2]) objects |= bit(kPlayfield);
  return objects;
}

}  // namespace

constinit const std::array<LineEffect, 64> kLineEffects = make_effects();

TiaRegisters line_key(const TiaRegisters& registers, std::uint8_t involved_by_events) {
  TiaRegisters key = registers;
  if (registers.vblank && !(involved_by_events & kBlanks)) {
    key = TiaRegisters{};
    key.vblank = 1;
    return key;
  }
  const std::uint8_t seen = enabled_objects(registers) | involved_by_events;
  const bool moves = (seen & kMovesObjects) != 0;
  for (unsigned i = 0; i < 2; ++i) {
    const bool player = (seen & bit(kP0 + i)) != 0, missile = (seen & bit(kM0 + i)) != 0;
    const std::uint8_t nusiz = key.player[i].nusiz;
    if (!player) key.player[i] = PlayerState{};
    if (!missile) key.missile[i] = MissileState{};
    if (!moves) key.player[i].motion = key.missile[i].motion = 0;
    if (missile) key.player[i].nusiz = nusiz;
    if (!player && !missile && !(key.ctrlpf & 2)) key.color[i] = 0;  // score mode shows them in the playfield
  }
  if (!(seen & bit(kBall))) key.ball = BallState{};
  else if (!moves) key.ball.motion = 0;
  if (!(seen & (bit(kBall) | bit(kPlayfield)))) key.color[2] = 0;
  return key;
}

}  // namespace racebeam
