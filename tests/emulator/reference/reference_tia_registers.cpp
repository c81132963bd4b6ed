// The effect of register writes: docs/spec/tia.md, 4 and 7 to 9.
#include <algorithm>

#include "tests/emulator/reference/reference_tia.hpp"

namespace racebeam::test {
namespace {

// clang-format off
// Registers by number, so that nothing is shared with the tested machine.
enum : unsigned {
  VBLANK = 0x01, NUSIZ0 = 0x04, NUSIZ1, COLUP0, COLUP1, COLUPF, COLUBK, CTRLPF, REFP0, REFP1, PF0, PF1, PF2,
  RESP0, RESP1, RESM0, RESM1, RESBL, GRP0 = 0x1B, GRP1, ENAM0, ENAM1, ENABL, HMP0, HMP1, HMM0, HMM1, HMBL,
  VDELP0, VDELP1, VDELBL, RESMP0, RESMP1, HMOVE, HMCLR, CXCLR
};
// clang-format on

// Section 4: how many clocks pass before a write takes effect.
int delay(unsigned reg, int x) {
  static constexpr int kPlayfield[4] = {4, 5, 2, 3};
  switch (reg) {
    case VBLANK:
    case REFP0:
    case REFP1:
    case GRP0:
    case GRP1: return 1;
    case NUSIZ0:
    case NUSIZ1:
    case RESM0:
    case RESM1: return 8;
    case PF0:
    case PF1:
    case PF2: return kPlayfield[x % 4];
    default: return 0;
  }
}

// Section 9: what HMOVE at cycle x adds to a position.
int movement(int x, int nibble) {
  struct Row {
    int from, value;
  };
  static constexpr Row kLim[] = {{4, 6},   {5, 5},   {7, 4},   {8, 3},   {9, 2},   {11, 1}, {12, 0},
                                 {13, -1}, {15, -2}, {16, -3}, {17, -4}, {19, -5}, {20, -6}};
  static constexpr Row kK[] = {{55, 6},  {56, 5},  {57, 4},  {59, 3},  {60, 2},  {61, 1},  {63, 0}, {64, -1},
                               {65, -2}, {67, -3}, {68, -4}, {69, -5}, {71, -6}, {72, -7}, {73, -8}};
  const int s = nibble < 8 ? nibble : nibble - 16;
  int value = 7;
  if (x == 75 || x <= 20) {
    for (const Row& row : kLim)
      if (x != 75 && x >= row.from) value = row.value;
    return -std::min(s, value);
  }
  if (x <= 54) return 0;
  for (const Row& row : kK)
    if (x >= row.from) value = row.value;
  return -std::max(0, s - value);
}

}  // namespace

// Section 4.
void ReferenceTia::write(int T, unsigned reg, std::uint8_t value) {
  const int c = 3 * T;
  draw_to(c + delay(reg, h(c) / 3));
  apply(c, reg, value);
}

void ReferenceTia::apply(int c, unsigned reg, std::uint8_t v) {
  const auto bit = [v](int n) { return v >> n & 1; };
  switch (reg) {
    case VBLANK: vblank_ = bit(1); break;
    case NUSIZ0:
    case NUSIZ1:
      player_[reg - NUSIZ0].mode = v & 7;
      player_[reg - NUSIZ0].skip = false;
      missile_[reg - NUSIZ0].size = v >> 4 & 3;
      if (reg == NUSIZ0) m0_shape_ = Shape::Normal;
      break;
    case COLUP0:
    case COLUP1:
    case COLUPF:
    case COLUBK: color_[reg - COLUP0] = (v & 0xFE) | (window_.pal ? lines_of_frame_ & 1 : 0); break;
    case CTRLPF:
      ctrlpf_ = v;
      ball_.size = v >> 4 & 3;
      if (h(c) < 147) reflect_ = bit(0);
      break;
    case REFP0:
    case REFP1: player_[reg - REFP0].refp = bit(3); break;
    case PF0:
    case PF1:
    case PF2: pf_[reg - PF0] = v; break;
    case RESP0:
    case RESP1: strobe_player(player_[reg - RESP0], c); break;
    case RESM0:
    case RESM1: strobe_missile(static_cast<int>(reg - RESM0), c); break;
    case RESBL: strobe_ball(c); break;
    case GRP0:
      player_[0].grp = v;
      player_[1].old = player_[1].grp;
      break;
    case GRP1:
      player_[1].grp = v;
      player_[0].old = player_[0].grp;
      ball_.old = ball_.enabl;
      break;
    case ENAM0:
    case ENAM1: missile_[reg - ENAM0].enam = bit(1); break;
    case ENABL: ball_.enabl = bit(1); break;
    case HMP0:
    case HMP1: player_[reg - HMP0].hm = v >> 4; break;
    case HMM0:
      if (c == last_hmove_ + 63 && missile_[0].hm == 7 && v >> 4 == 6) {
        cosmic_ = true;
        counter_ = 0;
      }
      missile_[0].hm = v >> 4;
      break;
    case HMM1: missile_[1].hm = v >> 4; break;
    case HMBL: ball_.hm = v >> 4; break;
    case VDELP0:
    case VDELP1: player_[reg - VDELP0].vdel = bit(0); break;
    case VDELBL: ball_.vdel = bit(0); break;
    case RESMP0:
    case RESMP1:
      if (missile_[reg - RESMP0].resmp && !bit(1)) release(static_cast<int>(reg - RESMP0));
      missile_[reg - RESMP0].resmp = bit(1);
      break;
    case HMOVE: strobe_hmove(c); break;
    case HMCLR: player_[0].hm = player_[1].hm = missile_[0].hm = missile_[1].hm = ball_.hm = 0; break;
    case CXCLR: collided_ = {}; break;
    default: break;
  }
}

// Section 8.
void ReferenceTia::strobe_player(Player& player, int c) {
  const int position = h(c) < 68 ? 3 : mod(h(c) - 68 + 5, 160);
  const int v = mod(position - player.pos, 160);
  const int w = player.mode == 5 ? 16 : player.mode == 7 ? 32 : 8;
  bool hits_delay = false, hits_copy = false;
  for (const int o : offsets(player.mode)) {
    hits_delay = hits_delay || (v >= o && v <= o + 3);
    hits_copy = hits_copy || (v >= o + 4 && v <= o + 3 + w);
  }
  if (hits_copy) draw_to(c + 11);
  player.pos = position;
  player.skip = !hits_delay;
}

void ReferenceTia::strobe_missile(int i, int c) {
  const int D = c - last_hmove_;
  int position = h(c) < 68 ? 2 : mod(h(c) - 68 + 4, 160);
  if (i == 0 && D == 60 && h(c) == 69) position = 8;
  if (i == 1 && D == 9 && h(c) == 18) position = 3;
  missile_[static_cast<std::size_t>(i)].pos = position;
  if (i == 0) m0_shape_ = Shape::Normal;
}

void ReferenceTia::strobe_ball(int c) {
  const int D = c - last_hmove_, at = h(c);
  ball_.pos = at < 68 ? 2 : mod(at - 68 + 4, 160);
  if (D == 54 && (at == 60 || at == 69)) ball_.pos = 10;
  if (D == 9 && at == 18) ball_.pos = 3;
  if (D == 21 && at == 30) ball_.pos = 6;
  if (D == 18 && at == 27) ball_.pos = 5;
}

void ReferenceTia::release(int i) {
  const Player& player = player_[static_cast<std::size_t>(i)];
  missile_[static_cast<std::size_t>(i)].pos = mod(player.pos + (player.mode == 5   ? 8
                                                                : player.mode == 7 ? 16
                                                                                   : 4),
                                                  160);
  if (i == 0) m0_shape_ = Shape::Normal;
}

// Section 9.
void ReferenceTia::strobe_hmove(int c) {
  const int x = h(c) / 3;
  const auto move = [x](auto& object) { object.pos = mod(object.pos + movement(x, object.hm), 160); };
  for (Player& player : player_) {
    move(player);
    player.skip = false;
  }
  for (Missile& missile : missile_) move(missile);
  move(ball_);
  if (window_.hmove_blanks && (x == 75 || x <= 20)) blank_armed_ = true;
  cosmic_ = false;
  m0_shape_ = Shape::Normal;
  last_hmove_ = c;
}

}  // namespace racebeam::test
