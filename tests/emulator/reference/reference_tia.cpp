#include "tests/emulator/reference/reference_tia.hpp"

#include <algorithm>
#include <sstream>

#include "emulator/state/state.hpp"

namespace racebeam::test {
namespace {

constexpr int kRows = 320;
enum : unsigned { COLUP0, COLUP1, COLUPF, COLUBK };

}  // namespace

ReferenceTia::ReferenceTia(const Window& window) : window_(window) {
  for (Buffer& buffer : buffer_) buffer.assign(kRows * 160, 0);
}

void ReferenceTia::open_frame(int T) {
  current_ = 1 - current_;
  lines_of_frame_ = (3 * T - F_) / 228;
  const int hh = mod(3 * T - F_, 228);
  last_hmove_ -= 3 * T;
  F_ = -hh;
  S_ = F_ + 228 * window_.ystart;
  W_ = S_ + 228 * window_.height;
  L_ = S_;
  E_ = 228;
  pointer_ = 0;
  if (!window_.pal) return;
  for (int& color : color_) color = (color & 0xFE) | (lines_of_frame_ & 1);
}

void ReferenceTia::reset_in_frame() {
  const int current = current_;
  *this = ReferenceTia(window_);
  current_ = current;
  S_ = 228 * window_.ystart;
  W_ = S_ + 228 * window_.height;
}

void ReferenceTia::take_machine_of(const ReferenceTia& other) {
  const std::array<Buffer, 2> buffers = buffer_;
  const int current = current_;
  *this = other;
  buffer_ = buffers;
  current_ = current;
}

// Section 5.
void ReferenceTia::draw_to(int k) {
  if (k < S_ || L_ >= W_ || L_ >= k) return;
  k = std::min(k, W_);
  while (L_ < k) {
    int b = 228 - E_;
    const bool completed = k > L_ + E_;
    int m = completed ? E_ : k - L_;
    E_ = completed ? 228 : E_ - m;
    L_ += m;
    if (b < 68) {
      const int q = std::min(68 - b, m);
      b += q;
      m -= q;
    }
    const int before = pointer_;
    draw_pixels(b - 68, m);
    pointer_ = before + m;
    if (blank_armed_ && b < 76) {
      std::fill_n(buffer_[static_cast<std::size_t>(current_)].begin() + before, 76 - b, std::uint8_t{0});
      if (b + m >= 76) blank_armed_ = false;
    }
    if (completed) end_line();
  }
}

void ReferenceTia::end_line() {
  reflect_ = ctrlpf_ & 1;
  for (Player& player : player_) player.skip = false;
  if (!cosmic_) return;
  static constexpr int kStep[4] = {18, 33, 0, 17};
  counter_ = (counter_ + 1) % 4;
  missile_[0].pos = mod(missile_[0].pos - kStep[counter_], 160);
  m0_shape_ = counter_ == 1 ? Shape::Stretched : counter_ == 2 ? Shape::Hidden : Shape::Normal;
}

// Section 6: `count` pixels from `first` on, four at a time where the reference does so.
void ReferenceTia::draw_pixels(int first, int count) {
  std::uint8_t* row = buffer_[static_cast<std::size_t>(current_)].data() + pointer_ - first;
  for (const Object object : kObjects) enabled_[object] = enabled(object);
  const bool grouped = !vblank_ && group_rule();
  for (int p = first; p < first + count;) {
    draw_pixel(p, row + p);
    if (grouped && p % 4 == 0 && group_is_clear(p)) {
      for (int i = 1; i < 4; ++i) row[p + i] = row[p];
      p += 4;
    } else {
      ++p;
    }
  }
}

void ReferenceTia::draw_pixel(int p, std::uint8_t* at) {
  *at = 0;
  if (vblank_) return;
  std::array<bool, kObjectCount> on;
  for (int i = 0; i < kObjectCount; ++i) on[static_cast<std::size_t>(i)] = active(static_cast<Object>(i), p);
  for (std::size_t a = 0; a < kObjectCount; ++a)
    for (std::size_t b = 0; b < kObjectCount; ++b)
      if (a != b && on[a] && on[b]) collided_[a][b] = true;
  *at = color_of(on, p);
}

bool ReferenceTia::group_rule() const {
  static constexpr unsigned p0 = 1u << P0, p1 = 1u << P1, m0 = 1u << M0, m1 = 1u << M1, bl = 1u << BL,
                            pf = 1u << PF;
  static constexpr unsigned kAlways[] = {pf, p0, p1, p0 | p1, m0, m1, bl, m0 | m1, bl | m0, bl | m1, bl | p1};
  static constexpr unsigned kUnlessScore[] = {pf | p0, pf | p1, pf | bl};
  unsigned on = 0;
  for (const Object object : kObjects) on |= enabled_[object] ? 1u << object : 0;
  const auto lists = [on](const auto& sets) {
    return std::find(std::begin(sets), std::end(sets), on) != std::end(sets);
  };
  return lists(kAlways) || ((ctrlpf_ & 2) == 0 && lists(kUnlessScore));
}

bool ReferenceTia::group_is_clear(int p) const {
  for (const Object object : {P0, P1, M0, M1, BL})
    for (int i = 0; i < 4; ++i)
      if (enabled_[object] && shape(object, p + i)) return false;
  return true;
}

// Section 7.
const std::vector<int>& ReferenceTia::offsets(int mode) {
  static const std::vector<int> kOffsets[8] = {{0},     {0, 16}, {0, 32},     {0, 16, 32},
                                               {0, 64}, {0},     {0, 32, 64}, {0}};
  return kOffsets[mode];
}

int ReferenceTia::graphics(const Player& player) const {
  int graphics = player.vdel ? player.old : player.grp;
  if (!player.refp) return graphics;
  int reversed = 0;
  for (int i = 0; i < 8; ++i) reversed |= (graphics >> i & 1) << (7 - i);
  return reversed;
}

bool ReferenceTia::enabled(Object object) const {
  switch (object) {
    case P0:
    case P1: return graphics(player_[object - P0]) != 0;
    case M0:
    case M1: return missile_[object - M0].enam && !missile_[object - M0].resmp;
    case BL: return ball_.vdel ? ball_.old : ball_.enabl;
    default: return (pf_[0] & 0xF0) != 0 || pf_[1] != 0 || pf_[2] != 0;
  }
}

int ReferenceTia::player_bit(const Player& player, int p) const {
  const int u = mod(p - player.pos, 160);
  if (player.mode == 5) return !player.skip && u >= 1 && u <= 16 ? 7 - (u - 1) / 2 : -1;
  if (player.mode == 7) return !player.skip && u >= 1 && u <= 32 ? 7 - (u - 1) / 4 : -1;
  for (const int o : offsets(player.mode))
    if (!(o == 0 && player.skip) && u >= o && u < o + 8) return 7 - (u - o);
  return -1;
}

bool ReferenceTia::shape(Object object, int p) const {
  if (object == P0 || object == P1) return player_bit(player_[object - P0], p) >= 0;
  if (object == BL) return mod(p - ball_.pos, 160) < 1 << ball_.size;
  const int i = object - M0;
  int size = missile_[static_cast<std::size_t>(i)].size;
  if (i == 0 && m0_shape_ == Shape::Hidden) return false;
  if (i == 0 && m0_shape_ == Shape::Stretched) size |= 1;
  const int u = mod(p - missile_[static_cast<std::size_t>(i)].pos, 160);
  for (const int o : offsets(player_[static_cast<std::size_t>(i)].mode))
    if (u >= o && u < o + (1 << size)) return true;
  return false;
}

bool ReferenceTia::active(Object object, int p) const {
  if (!enabled_[object]) return false;
  if (object == P0 || object == P1) {
    const int bit = player_bit(player_[object - P0], p);
    return bit >= 0 && (graphics(player_[object - P0]) >> bit & 1);
  }
  if (object != PF) return shape(object, p);
  const int j = p / 4;
  const int i = j < 20 ? j : reflect_ ? 39 - j : j - 20;
  const int bits = pf_[0] >> 4 | pf_[1] << 4 | pf_[2] << 12;
  return bits >> (i >= 4 && i < 12 ? 15 - i : i) & 1;
}

// Section 10.
std::uint8_t ReferenceTia::color_of(const std::array<bool, kObjectCount>& on, int p) const {
  const bool score = ctrlpf_ & 2, priority = ctrlpf_ & 4, left = p < 80;
  const auto color = [this](unsigned which) { return static_cast<std::uint8_t>(color_[which]); };
  const bool first = on[P0] || on[M0], second = on[P1] || on[M1];
  if (priority) {
    const bool alone = !enabled_[P0] && !enabled_[P1] && !enabled_[M0] && !enabled_[M1] && !enabled_[BL];
    if (on[PF] && score && alone) return color(left ? COLUP0 : COLUP1);
    if (on[PF] || on[BL]) return color(COLUPF);
    return color(first ? COLUP0 : second ? COLUP1 : COLUBK);
  }
  if (first) return color(COLUP0);
  if (score && on[PF] && left) return color(COLUP0);
  if (second) return color(COLUP1);
  if (score && on[PF]) return color(COLUP1);
  return color(on[PF] || on[BL] ? COLUPF : COLUBK);
}

namespace {

struct Pair {
  int a, b;
};

// Section 11, D7 and D6 of each register. An object does not collide with itself.
enum { p0, p1, m0, m1, bl, pf };
constexpr Pair kLatch[8][2] = {{{m0, p1}, {m0, p0}}, {{m1, p0}, {m1, p1}}, {{p0, pf}, {p0, bl}},
                               {{p1, pf}, {p1, bl}}, {{m0, pf}, {m0, bl}}, {{m1, pf}, {m1, bl}},
                               {{bl, pf}, {bl, bl}}, {{p0, p1}, {m0, m1}}};

}  // namespace

unsigned ReferenceTia::read(int T, unsigned reg) {
  draw_to(3 * T);
  const auto met = [this](const Pair& pair) -> unsigned {
    return collided_[static_cast<std::size_t>(pair.a)][static_cast<std::size_t>(pair.b)];
  };
  return met(kLatch[reg][0]) << 7 | met(kLatch[reg][1]) << 6;
}

void ReferenceTia::meet(unsigned packed) {
  for (unsigned reg = 0; reg < 8; ++reg)
    for (unsigned i = 0; i < 2; ++i) {
      const auto a = static_cast<std::size_t>(kLatch[reg][i].a),
                 b = static_cast<std::size_t>(kLatch[reg][i].b);
      if (a != b) collided_[a][b] = collided_[b][a] = packed >> (2 * reg + 1 - i) & 1;
    }
}

std::string ReferenceTia::difference(const TiaState& tia) const {
  std::ostringstream out;
  const auto check = [&out](const std::string& name, int ours, int theirs) {
    if (ours != theirs) out << name << " " << ours << ", not " << theirs << "; ";
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string n(1, static_cast<char>('0' + i));
    check("GRP" + n, tia.player[i].grp, player_[i].grp);
    check("old GRP" + n, tia.player[i].old_grp, player_[i].old);
    check("REFP" + n, tia.player[i].refp, player_[i].refp);
    check("VDELP" + n, tia.player[i].vdel, player_[i].vdel);
    check("mode " + n, tia.player[i].nusiz & 7, player_[i].mode);
    check("P" + n + " position", tia.player[i].position, player_[i].pos);
    check("HMP" + n, tia.player[i].motion, player_[i].hm);
    check("skip " + n, tia.player[i].skip, player_[i].skip);
    check("ENAM" + n, tia.missile[i].enabled, missile_[i].enam);
    check("RESMP" + n, tia.missile[i].locked, missile_[i].resmp);
    check("M" + n + " size", tia.player[i].nusiz >> 4 & 3, missile_[i].size);
    check("M" + n + " position", tia.missile[i].position, missile_[i].pos);
    check("HMM" + n, tia.missile[i].motion, missile_[i].hm);
  }
  check("ENABL", tia.ball.enabled, ball_.enabl);
  check("old ENABL", tia.ball.old_enabled, ball_.old);
  check("VDELBL", tia.ball.vdel, ball_.vdel);
  check("BL position", tia.ball.position, ball_.pos);
  check("HMBL", tia.ball.motion, ball_.hm);
  for (std::size_t i = 0; i < 3; ++i) check("PF" + std::to_string(i), tia.pf[i], pf_[i]);
  for (std::size_t i = 0; i < 4; ++i) check("color " + std::to_string(i), tia.color[i], color_[i]);
  check("CTRLPF", tia.ctrlpf & 0x37, ctrlpf_ & 0x37);
  check("reflect", tia.reflect, reflect_);
  check("VBLANK", tia.vblank, vblank_);
  check("blank armed", tia.comb_armed, blank_armed_);
  check("cosmic", tia.cosmic, cosmic_);
  check("cosmic shape", static_cast<int>(tia.cosmic_shape), static_cast<int>(m0_shape_));
  unsigned packed = 0;
  for (unsigned reg = 0; reg < 8; ++reg) {
    const auto met = [this](const Pair& pair) -> unsigned {
      return collided_[static_cast<std::size_t>(pair.a)][static_cast<std::size_t>(pair.b)];
    };
    packed |= (met(kLatch[reg][0]) << 1 | met(kLatch[reg][1])) << (2 * reg);
  }
  check("collisions", tia.collisions, static_cast<int>(packed));
  return out.str();
}

}  // namespace racebeam::test
