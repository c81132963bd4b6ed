#include "emulator/line_key.hpp"

#include <bit>

#include "emulator/inlining.hpp"
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
    case VDELP0: case RESP0: return bit(kP0);  // RESPx: the old place decides how far the beam draws ahead
    case VDELP1: case RESP1: return bit(kP1);
    case CTRLPF: return bit(kP0) | bit(kP1);   // score mode shows the players' colours
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
    table[reg] = {static_cast<std::int8_t>((228 - longest_delay(reg)) / 3), involved_by(reg)};
  return table;
}

RACEBEAM_INLINE unsigned enabled_objects(const TiaRegisters& r) {
  unsigned objects = (ball_enabled(r.ball) ? 1U : 0U) << kBall;
  for (unsigned i = 0; i < 2; ++i) {
    objects |= (shown_graphics(r.player[i]) != 0 ? 1U : 0U) << (kP0 + i);
    objects |= (missile_enabled(r.missile[i]) ? 1U : 0U) << (kM0 + i);
  }
  return objects | (((r.pf[0] & 0xF0) | r.pf[1] | r.pf[2]) != 0 ? 1U : 0U) << kPlayfield;
}

constexpr std::uint64_t make_drawing_registers() {
  std::uint64_t registers = 0;
  for (unsigned reg = 0; reg < 64; ++reg)
    if (draws(reg)) registers |= std::uint64_t{1} << reg;
  return registers;
}

// Bit 7 of an index to kMasks: score mode shows the players' colours in the playfield.
constexpr std::uint8_t kScoreMode = 1U << 7;

// The bytes of the registers that can be seen are $FF, the others 0.
constexpr TiaRegisters make_mask(unsigned seen) {
  const auto shown = [seen](unsigned bits) { return static_cast<std::uint8_t>(seen & bits ? 0xFF : 0); };
  const std::uint8_t motion = shown(kMovesObjects);
  TiaRegisters mask;
  for (unsigned i = 0; i < 2; ++i) {
    const std::uint8_t player = shown(bit(kP0 + i)), missile = shown(bit(kM0 + i));
    const std::uint8_t moves = player & motion, either = player | missile;
    mask.player[i] = {player, player, player, player, either, player, moves, player};
    mask.missile[i] = {missile, missile, missile, static_cast<std::uint8_t>(missile & motion)};
    mask.color[i] = either | shown(kScoreMode);
  }
  const std::uint8_t ball = shown(bit(kBall));
  mask.ball = {ball, ball, ball, ball, static_cast<std::uint8_t>(ball & motion)};
  mask.color[2] = shown(bit(kBall) | bit(kPlayfield));
  mask.color[3] = mask.ctrlpf = mask.reflect = 0xFF;
  mask.pf = {0xFF, 0xFF, 0xFF};
  mask.vblank = mask.comb_armed = mask.cosmic = mask.cosmic_count = 0xFF;
  mask.cosmic_shape = static_cast<CosmicShape>(0xFF);
  return mask;
}

using Words = std::array<std::uint64_t, sizeof(TiaRegisters) / sizeof(std::uint64_t)>;

constexpr std::array<Words, 256> make_masks() {
  std::array<Words, 256> table{};
  for (unsigned seen = 0; seen < 256; ++seen) table[seen] = std::bit_cast<Words>(make_mask(seen));
  return table;
}
constexpr auto kMasks = make_masks();

constexpr Words make_black_mask() {
  TiaRegisters mask;
  mask.vblank = 0xFF;
  return std::bit_cast<Words>(mask);
}
constexpr Words kBlackMask = make_black_mask();

RACEBEAM_INLINE const Words& mask_of(const TiaRegisters& registers, std::uint8_t involved) {
  if (registers.vblank && !(involved & kBlanks)) return kBlackMask;
  const unsigned score = registers.ctrlpf & 2 ? kScoreMode : 0U;
  return kMasks[enabled_objects(registers) | (involved & ~unsigned{kBlanks}) | score];
}

}  // namespace

constinit const std::uint64_t kDrawingRegisters = make_drawing_registers();
constinit const std::array<LineEffect, 64> kLineEffects = make_effects();

TiaRegisters line_key(const TiaRegisters& registers, std::uint8_t involved) {
  Words words = std::bit_cast<Words>(registers);
  const Words& mask = mask_of(registers, involved);
  for (std::size_t i = 0; i < words.size(); ++i) words[i] &= mask[i];
  return std::bit_cast<TiaRegisters>(words);
}

bool has_key(const TiaRegisters& registers, std::uint8_t involved, const TiaRegisters& key) {
  const Words words = std::bit_cast<Words>(registers), wanted = std::bit_cast<Words>(key);
  const Words& mask = mask_of(registers, involved);
  std::uint64_t difference = 0;
  for (std::size_t i = 0; i < words.size(); ++i) difference |= (words[i] & mask[i]) ^ wanted[i];
  return difference == 0;
}

}  // namespace racebeam
