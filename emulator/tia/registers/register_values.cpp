#include "emulator/tia/registers/register_values.hpp"

namespace racebeam {
namespace {

constexpr std::uint32_t kNoVsync = 0x7FFFFFFF;

std::uint8_t flag(int number, bool is_set) { return static_cast<std::uint8_t>(is_set ? 1 << number : 0); }
std::uint8_t nibble(std::uint8_t motion) { return static_cast<std::uint8_t>(motion << 4); }

std::uint8_t value_of(TiaRegister reg, const State& state, const Sound& sound) {
  const TiaState& tia = state.tia;
  const auto& [p0, p1] = tia.player;
  const auto& [m0, m1] = tia.missile;
  const BallState& ball = tia.ball;
  // clang-format off
  switch (reg) {
    case VSYNC:  return flag(1, state.frame.vsync_finish != kNoVsync);
    case VBLANK: return flag(1, tia.vblank) | flag(7, state.frame.dumping);
    case NUSIZ0: return p0.nusiz;
    case NUSIZ1: return p1.nusiz;
    case COLUP0: case COLUP1: case COLUPF: case COLUBK: return tia.color[reg - COLUP0] & 0xFE;
    case CTRLPF: return tia.ctrlpf;
    case REFP0:  return flag(3, p0.refp);
    case REFP1:  return flag(3, p1.refp);
    case PF0: case PF1: case PF2: return tia.pf[reg - PF0];
    case RESP0:  return p0.position;
    case RESP1:  return p1.position;
    case RESM0:  return m0.position;
    case RESM1:  return m1.position;
    case RESBL:  return ball.position;
    case AUDC0: case AUDC1: case AUDF0: case AUDF1: case AUDV0: case AUDV1: return sound.registers[reg - AUDC0];
    case GRP0:   return p0.grp;
    case GRP1:   return p1.grp;
    case ENAM0:  return flag(1, m0.enabled);
    case ENAM1:  return flag(1, m1.enabled);
    case ENABL:  return flag(1, ball.enabled);
    case HMP0:   return nibble(p0.motion);
    case HMP1:   return nibble(p1.motion);
    case HMM0:   return nibble(m0.motion);
    case HMM1:   return nibble(m1.motion);
    case HMBL:   return nibble(ball.motion);
    case VDELP0: return flag(0, p0.vdel);
    case VDELP1: return flag(0, p1.vdel);
    case VDELBL: return flag(0, ball.vdel);
    case RESMP0: return flag(1, m0.locked);
    case RESMP1: return flag(1, m1.locked);
    case WSYNC: case RSYNC: case HMOVE: case HMCLR: case CXCLR: case kTiaRegisters: case kNone: return 0;
  }
  // clang-format on
  return 0;
}

}  // namespace

std::array<std::uint8_t, kTiaValues> tia_values(const State& state, const Sound& sound) {
  std::array<std::uint8_t, kTiaValues> values{};
  for (std::size_t reg = 0; reg < kTiaRegisters; ++reg)
    values[reg] = value_of(static_cast<TiaRegister>(reg), state, sound);
  for (std::size_t pair = 0; pair < kCollisionLatches; ++pair)
    values[kTiaRegisters + pair] = static_cast<std::uint8_t>((state.tia.collisions >> (2 * pair) & 3) << 6);
  return values;
}

}  // namespace racebeam
