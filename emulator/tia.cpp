#include "emulator/tia.hpp"

#include <algorithm>
#include <limits>

#include "emulator/line_key.hpp"
#include "emulator/motion.hpp"
#include "emulator/registers.hpp"

namespace racebeam {
namespace {

constexpr std::uint8_t object(unsigned first, unsigned which) { return static_cast<std::uint8_t>(1U << (first + which)); }
constexpr std::uint8_t kBallBit = 1U << kBall, kPlayfieldBit = 1U << kPlayfield;
constexpr std::uint8_t kNoObject = 0;

// Does the same write on the same line always do the same? CXCLR acts on lines before, and what may be the start of
// Cosmic Ark mode depends on when the last HMOVE was.
constexpr bool is_repeatable(const TiaAccess& access) {
  return access.reg != CXCLR && !(access.reg == HMM0 && access.value >> 4 == 6);
}

std::uint8_t moved(int position, int by) {
  return static_cast<std::uint8_t>((position + by + kLinePixels) % kLinePixels);
}

}  // namespace

void Tia::begin_frame() {
  beam_.begin_frame();
  if (!video_.pal) return;
  for (std::uint8_t& color : tia_.color) color = static_cast<std::uint8_t>((color & 0xFE) | color_loss());
}

void Tia::begin_step(Picture& picture) {
  log.size = 0;
  played_ = 0;
  reached_ = std::numeric_limits<std::int32_t>::min();
  beam_.aim(picture);
  beam_.changed(kNoObject);
  at_begin_ = tia_;
}

void Tia::catch_up(std::int32_t cycle) {
  play_until(log.size);
  draw_to(3 * cycle);
}

void Tia::end_step(std::int32_t last_access) {
  catch_up(last_access);
  if (!beam_.inside_window()) return;
  // The picture stops inside the window, where what the reference writes ahead of the beam can be seen: play the
  // step again, access by access.
  tia_ = at_begin_;
  beam_.forget();
  beam_.set_exact_spans(true);
  played_ = 0;
  reached_ = std::numeric_limits<std::int32_t>::min();
  catch_up(last_access);
  beam_.set_exact_spans(false);
}

void Tia::play_until(std::size_t end) {
  while (played_ < end) {
    if (!play_line(end)) play(log.entry[played_++]);
  }
}

// Plays a whole line at once, if the beam is at its start and the next access is known to lie beyond its end. A line
// that starts with the same registers and meets the same writes as when this row of the buffer was drawn last is there
// already.
bool Tia::play_line(std::size_t end) {
  const std::int32_t clock = 3 * log.entry[played_].cycle;
  if (clock <= beam_.start() || !beam_.line_can_end() || beam_.exact_spans()) return false;
  if (!beam_.at_line_start()) {
    if (clock <= beam_.line_end()) return false;
    beam_.finish_line();
    return true;
  }
  if (reached_ > tia_.cursor) return false;
  LineRecord line;
  const std::size_t next = gather_events(end, line);
  if (next == end) return false;
  if (beam_.record().same_line(line)) recall_line(next);
  else draw_line(next, line);
  return true;
}

// The accesses of the cursor's line, and its key. Returns the first one beyond it, or `end` when the line can't be taken
// as a whole.
std::size_t Tia::gather_events(std::size_t end, LineRecord& line) const {
  const std::int32_t line_end = beam_.line_end();
  const std::int32_t first_cycle = line_end / 3 - kLineCycles;
  std::uint8_t involved = 0;
  unsigned count = 0;
  for (std::size_t i = played_; i < end; ++i) {
    const TiaAccess& access = log.entry[i];
    const std::int32_t cycle = access.cycle - first_cycle;
    if (cycle > kLineCycles) {
      line.count = static_cast<std::uint8_t>(count);
      line.key = line_key(tia_.registers(), involved);
      return i;
    }
    const LineEffect effect = kLineEffects[access.reg];
    if (!effect.draws) continue;
    if (count == line.event.size() || cycle > effect.last_cycle || !is_repeatable(access)) break;
    involved |= effect.involved;
    line.event[count++] = LineEvent(cycle, access.reg, access.value);
  }
  return end;
}

void Tia::recall_line(std::size_t next) {
  drawn_already_ = true;
  while (played_ < next) play(log.entry[played_++]);
  drawn_already_ = false;
  beam_.take_line(beam_.record());
}

void Tia::draw_line(std::size_t next, LineRecord& line) {
  LineRecord& record = beam_.record();
  const std::uint16_t collisions = tia_.collisions;
  tia_.collisions = 0;  // the record keeps those of this line
  while (played_ < next) play(log.entry[played_++]);
  beam_.finish_line();
  line.meetings = tia_.collisions;
  line.repeats = beam_.repeats();
  line.comb_armed = tia_.comb_armed;
  tia_.collisions |= collisions;
  record = line;
}

void Tia::draw_to(std::int32_t clock) {
  reach(clock);
  if (!drawn_already_) beam_.draw_to(reached_);
}

template <class T>
bool Tia::assign(T& reg, T value, std::int32_t clock, std::uint8_t objects) {
  if (reg == value) {
    reach(clock);
    return false;
  }
  draw_to(clock);
  reg = value;
  beam_.changed(objects);
  return true;
}

// CPU cycle within the line, 0-75. The origin is a multiple of three.
int Tia::line_cycle(std::int32_t cycle) const { return (cycle - tia_.origin / 3) % kLineCycles; }

void Tia::play(const TiaAccess& access) {
  const std::int32_t clock = 3 * access.cycle;
  const std::uint8_t value = access.value;
  auto& [p0, p1] = tia_.player;
  auto& [m0, m1] = tia_.missile;
  BallState& ball = tia_.ball;
  const auto flag = [value](int bit) { return static_cast<std::uint8_t>(value >> bit & 1); };
  const auto motion = [value] { return static_cast<std::uint8_t>(value >> 4); };
  switch (access.reg) {
    case VBLANK: assign(tia_.vblank, flag(1), clock + 1, kNoObject); break;
    case NUSIZ0: write_nusiz(0, value, clock + 8); break;
    case NUSIZ1: write_nusiz(1, value, clock + 8); break;
    case COLUP0: case COLUP1: case COLUPF: case COLUBK: write_color(access.reg - COLUP0, value, clock); break;
    case CTRLPF: write_ctrlpf(value, clock); break;
    case REFP0:  assign(p0.refp, flag(3), clock + 1, object(kP0, 0)); break;
    case REFP1:  assign(p1.refp, flag(3), clock + 1, object(kP0, 1)); break;
    case PF0: case PF1: case PF2: write_playfield(access.reg - PF0, value, access); break;
    case RESP0:  strobe_player(0, clock); break;
    case RESP1:  strobe_player(1, clock); break;
    case RESM0:  strobe_missile(0, clock); break;
    case RESM1:  strobe_missile(1, clock); break;
    case RESBL:  strobe_ball(clock); break;
    case GRP0:   write_graphics(0, value, clock + 1); break;
    case GRP1:   write_graphics(1, value, clock + 1); break;
    case ENAM0:  assign(m0.enabled, flag(1), clock, object(kM0, 0)); break;
    case ENAM1:  assign(m1.enabled, flag(1), clock, object(kM0, 1)); break;
    case ENABL:  write_ball(flag(1), ball.old_enabled, ball.vdel, clock); break;
    case HMP0:   reach(clock); p0.motion = motion(); break;
    case HMP1:   reach(clock); p1.motion = motion(); break;
    case HMM0:   write_hmm0(motion(), clock); break;
    case HMM1:   reach(clock); m1.motion = motion(); break;
    case HMBL:   reach(clock); ball.motion = motion(); break;
    case VDELP0: write_vdel(0, flag(0), clock); break;
    case VDELP1: write_vdel(1, flag(0), clock); break;
    case VDELBL: write_ball(ball.enabled, ball.old_enabled, flag(0), clock); break;
    case RESMP0: write_resmp(0, flag(1), clock); break;
    case RESMP1: write_resmp(1, flag(1), clock); break;
    case HMOVE:  strobe_hmove(access); break;
    case HMCLR:  reach(clock); p0.motion = p1.motion = m0.motion = m1.motion = ball.motion = 0; break;
    case CXCLR:  clear_collisions(clock); break;
    default:     reach(clock); break;
  }
  if (beam_.exact_spans()) beam_.draw_to(reached_);
}

void Tia::write_color(unsigned which, std::uint8_t value, std::int32_t clock) {
  assign(tia_.color[which], static_cast<std::uint8_t>((value & 0xFE) | color_loss()), clock, kNoObject);
}

void Tia::write_nusiz(unsigned which, std::uint8_t value, std::int32_t clock) {
  PlayerState& player = tia_.player[which];
  const bool reselects = player.skip || (which == 0 && tia_.cosmic);
  value &= 0x37;
  if (player.nusiz == value && !reselects) return reach(clock);
  draw_to(clock);
  player.nusiz = value;
  player.skip = 0;
  if (which == 0) tia_.cosmic_shape = CosmicShape::kNormal;
  beam_.changed(object(kP0, which) | object(kM0, which));
}

void Tia::write_ctrlpf(std::uint8_t value, std::int32_t clock) {
  const bool latches = line_cycle(clock / 3) < 49;  // later, the playfield turns round at the end of the line only
  const std::uint8_t reflect = latches ? value & 1 : tia_.reflect;
  value &= 0x37;
  if (tia_.ctrlpf == value && tia_.reflect == reflect) return reach(clock);
  draw_to(clock);
  // Drawing may have passed a line's end, and with it the latch.
  tia_.reflect = latches ? value & 1 : tia_.reflect;
  tia_.ctrlpf = value;
  beam_.changed(kBallBit | kPlayfieldBit);
}

void Tia::write_playfield(unsigned which, std::uint8_t value, const TiaAccess& access) {
  static constexpr std::uint8_t kDelay[4] = {4, 5, 2, 3};  // until the next block of four pixels
  const std::int32_t clock = 3 * access.cycle;
  assign(tia_.pf[which], value, clock + kDelay[line_cycle(access.cycle) % 4], kPlayfieldBit);
}

// Writing one player's graphics moves the other's into the register that VDELPx shows.
void Tia::write_graphics(unsigned which, std::uint8_t value, std::int32_t clock) {
  PlayerState& written = tia_.player[which];
  PlayerState& other = tia_.player[1 - which];
  std::uint8_t objects = 0;
  if (!written.vdel && written.grp != value) objects |= object(kP0, which);
  if (other.vdel && other.old_grp != other.grp) objects |= object(kP0, 1 - which);
  if (which == 1 && tia_.ball.vdel && tia_.ball.old_enabled != tia_.ball.enabled) objects |= kBallBit;
  if (objects != 0) draw_to(clock);
  else reach(clock);
  written.grp = value;
  other.old_grp = other.grp;
  if (which == 1) tia_.ball.old_enabled = tia_.ball.enabled;
  if (objects != 0) beam_.changed(objects);
}

void Tia::write_vdel(unsigned which, std::uint8_t value, std::int32_t clock) {
  assign(tia_.player[which].vdel, value, clock, object(kP0, which));
}

void Tia::write_ball(std::uint8_t enabled, std::uint8_t old_enabled, std::uint8_t vdel, std::int32_t clock) {
  BallState& ball = tia_.ball;
  const bool shown = vdel ? old_enabled != 0 : enabled != 0;
  if (shown != ball_enabled(ball)) {
    draw_to(clock);
    beam_.changed(kBallBit);
  } else {
    reach(clock);
  }
  ball.enabled = enabled;
  ball.vdel = vdel;
}

// Unlocking a missile leaves it in the middle of its player.
void Tia::write_resmp(unsigned which, std::uint8_t value, std::int32_t clock) {
  MissileState& missile = tia_.missile[which];
  const bool unlocks = missile.locked && !value;
  if (!assign(missile.locked, value, clock, object(kM0, which)) || !unlocks) return;
  const PlayerState& player = tia_.player[which];
  missile.position = moved(player.position, 4 * static_cast<int>(kCopies[player.nusiz & 7].scale));
  if (which == 0) show_cosmic_normally();
}

// A second motion written exactly 21 cycles after an HMOVE keeps missile 0 moving: "Cosmic Ark mode".
void Tia::write_hmm0(std::uint8_t motion, std::int32_t clock) {
  MissileState& missile = tia_.missile[0];
  const bool enters = static_cast<std::uint32_t>(clock) == tia_.hmove_clock + 63 && missile.motion == 7 && motion == 6;
  if (enters) {
    draw_to(clock);
    tia_.cosmic = 1;
    tia_.cosmic_count = 0;
    beam_.changed(object(kM0, 0));
  }
  reach(clock);
  missile.motion = motion;
}

void Tia::show_cosmic_normally() {
  if (tia_.cosmic_shape == CosmicShape::kNormal) return;
  tia_.cosmic_shape = CosmicShape::kNormal;
  beam_.changed(object(kM0, 0));
}

std::uint8_t Tia::strobe_position(std::int32_t clock, int in_blank, int delay) const {
  const int h = 3 * line_cycle(clock / 3);
  return static_cast<std::uint8_t>(h < kBlankClocks ? in_blank : (h - kBlankClocks + delay) % kLinePixels);
}

void Tia::strobe_player(unsigned which, std::int32_t clock) {
  PlayerState& player = tia_.player[which];
  draw_to(clock);
  const std::uint8_t position = strobe_position(clock, 3, 5);
  const int distance = (position - player.position + kLinePixels) % kLinePixels;
  const Copies& copies = kCopies[player.nusiz & 7];
  const int width = 8 * static_cast<int>(copies.scale);
  bool skip = true;
  for (unsigned i = 0; i < copies.count; ++i) {
    const int into = distance - copies.offset[i];
    if (into >= 0 && into <= 3) skip = false;
    if (into >= 4 && into <= 3 + width) draw_to(clock + 11);  // the old copy is being drawn: it is finished first
  }
  player.position = position;
  player.skip = skip;
  beam_.changed(object(kP0, which));
}

void Tia::strobe_missile(unsigned which, std::int32_t clock) {
  draw_to(clock + 8);
  const std::uint32_t since = static_cast<std::uint32_t>(clock) - tia_.hmove_clock;
  const int h = 3 * line_cycle(clock / 3);
  std::uint8_t position = strobe_position(clock, 2, 4);
  if (which == 0 && since == 60 && h == 69) position = 8;
  if (which == 1 && since == 9 && h == 18) position = 3;
  tia_.missile[which].position = position;
  if (which == 0) show_cosmic_normally();
  beam_.changed(object(kM0, which));
}

void Tia::strobe_ball(std::int32_t clock) {
  struct Exception { std::uint32_t since; int h; std::uint8_t position; };
  static constexpr Exception kExceptions[] = {{54, 60, 10}, {54, 69, 10}, {9, 18, 3}, {21, 30, 6}, {18, 27, 5}};
  draw_to(clock);
  const std::uint32_t since = static_cast<std::uint32_t>(clock) - tia_.hmove_clock;
  const int h = 3 * line_cycle(clock / 3);
  tia_.ball.position = strobe_position(clock, 2, 4);
  for (const Exception& e : kExceptions)
    if (since == e.since && h == e.h) tia_.ball.position = e.position;
  beam_.changed(kBallBit);
}

void Tia::strobe_hmove(const TiaAccess& access) {
  const std::int32_t clock = 3 * access.cycle;
  const int x = line_cycle(access.cycle);
  draw_to(clock);
  const auto& movement = kMovement[static_cast<std::size_t>(x)];
  const auto move = [&](std::uint8_t& position, std::uint8_t motion, std::uint8_t objects) {
    if (movement[motion] == 0) return;
    position = moved(position, movement[motion]);
    beam_.changed(objects);
  };
  for (unsigned i = 0; i < 2; ++i) {
    PlayerState& player = tia_.player[i];
    move(player.position, player.motion, object(kP0, i));
    move(tia_.missile[i].position, tia_.missile[i].motion, object(kM0, i));
    if (player.skip) beam_.changed(object(kP0, i));
    player.skip = 0;
  }
  move(tia_.ball.position, tia_.ball.motion, kBallBit);
  if (video_.hmove_blanks && (x == 75 || x <= 20)) tia_.comb_armed = 1;
  tia_.cosmic = 0;
  show_cosmic_normally();
  tia_.hmove_clock = static_cast<std::uint32_t>(clock);
}

// What is not drawn yet may still meet: it is drawn before the latches are cleared.
void Tia::clear_collisions(std::int32_t clock) {
  draw_to(clock);
  if (tia_.collisions == 0) return;
  tia_.collisions = 0;
  beam_.changed(kNoObject);
}

// tia.md, section 2, "Greying": what is seen when the processor stands still in the middle of a picture.
void Tia::grey(Picture& picture, std::int32_t cycle) const {
  const int line = (3 * cycle - tia_.origin) / kLineClocks;
  const int first = std::max(line, video_.ystart) - video_.ystart;
  for (int i = first * kLinePixels; i < video_.height * kLinePixels; ++i)
    picture.pixel[static_cast<std::size_t>(i)] = (picture.pixel[static_cast<std::size_t>(i)] & 15) >> 1;
  picture.forget_lines();
}

}  // namespace racebeam
