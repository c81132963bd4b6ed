// The effect of a write to each register of the TIA (docs/spec/tia.md, 4 and 7 to 9). A policy is called
// before and after each change; render_policies.hpp describes its functions.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>

#include "emulator/base/inlining.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/beam.hpp"
#include "emulator/tia/line/objects.hpp"
#include "emulator/tia/registers/motion.hpp"
#include "emulator/tia/registers/registers.hpp"
#include "emulator/tia/registers/write_log.hpp"

namespace racebeam {

template <class T>
concept ChangePolicy = requires(const T& policy, std::int32_t clock, std::uint8_t objects,
                                PlayfieldPart part) {
  policy.reach(clock);
  policy.draw_to(clock, objects);
  policy.draw_before(clock, part);
  policy.advance_to(clock);
  policy.collide_to(clock);
  policy.changed(objects);
  policy.enabled_changed();
  policy.clear_collisions();
  { policy.is_active() } -> std::same_as<bool>;
  { policy.tracks(objects) } -> std::same_as<bool>;
};

template <ChangePolicy Policy>
class RegisterEffects {
 public:
  RegisterEffects(TiaState& state, const FrameState& frame, const Video& video, Policy policy)
      : tia_(state), frame_(frame), video_(video), first_cycle_(state.origin / 3), policy_(policy) {}

  // Plays the writes in [first, last) of a log, whose cycles count from `base`.
  void play(const std::uint32_t* first, const std::uint32_t* last, std::int32_t base);

 private:
  void play(TiaWrite write, std::int32_t cycle);

  static constexpr std::uint8_t kNoObject = 0, kBallBit = object_bit(kBall),
                                kPlayfieldBit = object_bit(kPlayfield);

  static constexpr std::uint8_t object(unsigned first, unsigned which) { return object_bit(first + which); }

  // Wraps a position that is at most one line off.
  static constexpr std::uint8_t wrapped(int position) {
    if (position < 0) position += kLinePixels;
    return static_cast<std::uint8_t>(position >= kLinePixels ? position - kLinePixels : position);
  }

  // Where a strobe at clock `h` of the line places an object.
  static constexpr std::uint8_t beam_position(int h, int in_blank, int delay) {
    return static_cast<std::uint8_t>(h < kBlankClocks ? in_blank : (h - kBlankClocks + delay) % kLinePixels);
  }

  bool any_motion() const {
    const auto& [p0, p1] = tia_.player;
    const auto& [m0, m1] = tia_.missile;
    return (p0.motion | p1.motion | m0.motion | m1.motion | tia_.ball.motion) != 0;
  }

  // The CPU cycle within the line, 0-75. It is exact, since the origin is a multiple of three.
  int line_cycle(std::int32_t cycle) const { return (cycle - first_cycle_) % kLineCycles; }

  // 1 if the picture loses its colour: PAL, after an odd number of lines (docs/spec/tia.md, 12).
  std::uint8_t color_loss() const { return video_.pal ? frame_.lines & 1 : 0; }

  // Updates which of these objects are enabled, after a write that may change it.
  RACEBEAM_INLINE void control(unsigned objects) {
    if (!policy_.tracks(objects)) return;
    const auto enabled = static_cast<std::uint8_t>((tia_.enabled & ~objects) | enabled_among(tia_, objects));
    if (enabled == tia_.enabled) return;
    tia_.enabled = enabled;
    policy_.enabled_changed();
  }

  template <class T>
  bool assign(T& reg, T value, std::int32_t clock, std::uint8_t objects);
  std::uint8_t strobe_position(TiaRegister reg, std::int32_t clock) const;
  void write_color(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_nusiz(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_ctrlpf(std::uint8_t value, std::int32_t clock);
  void write_playfield(unsigned which, std::uint8_t value, std::int32_t cycle);
  void write_graphics(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_vdel(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_ball(std::uint8_t enabled, std::uint8_t old_enabled, std::uint8_t vdel, std::int32_t clock);
  void write_resmp(unsigned which, std::uint8_t value, std::int32_t clock);
  void write_hmm0(std::uint8_t motion, std::int32_t clock);
  void strobe_player(unsigned which, std::int32_t clock);
  void strobe_missile(unsigned which, std::int32_t clock);
  void strobe_ball(std::int32_t clock);
  void strobe_hmove(std::int32_t cycle);
  void clear_collisions(std::int32_t clock);
  void end_cosmic_lines(std::int32_t clock);
  void show_cosmic_normally();

  TiaState& tia_;
  const FrameState& frame_;
  const Video& video_;
  const std::int32_t first_cycle_;  // of line 0
  Policy policy_;
};

template <ChangePolicy Policy>
template <class T>
RACEBEAM_INLINE bool RegisterEffects<Policy>::assign(T& reg, T value, std::int32_t clock,
                                                     std::uint8_t objects) {
  if (policy_.is_active() && reg == value) {
    policy_.reach(clock);
    return false;
  }
  policy_.draw_to(clock, objects);
  reg = value;
  policy_.changed(objects);
  return true;
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::play(const std::uint32_t* first, const std::uint32_t* last,
                                                   std::int32_t base) {
  for (const std::uint32_t* entry = first; entry != last; ++entry) {
    const TiaWrite write(*entry);
    play(write, base + write.cycle());
  }
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::play(TiaWrite write, std::int32_t cycle) {
  const std::int32_t clock = 3 * cycle;
  const auto after = [clock](TiaRegister reg) { return clock + kRegisters[reg].delay; };
  const std::uint8_t value = write.value();
  auto& [p0, p1] = tia_.player;
  auto& [m0, m1] = tia_.missile;
  BallState& ball = tia_.ball;
  const auto flag = [value](int bit) { return static_cast<std::uint8_t>(value >> bit & 1); };
  const auto motion = [value] { return static_cast<std::uint8_t>(value >> 4); };
  // clang-format off
  switch (write.reg()) {
    case VBLANK: assign(tia_.vblank, flag(1), after(VBLANK), kAllObjects); policy_.enabled_changed(); break;
    case NUSIZ0: write_nusiz(0, value, after(NUSIZ0)); break;
    case NUSIZ1: write_nusiz(1, value, after(NUSIZ1)); break;
    case COLUP0: case COLUP1: case COLUPF: case COLUBK: write_color(write.reg() - COLUP0, value, clock); break;
    case CTRLPF: write_ctrlpf(value, clock); break;
    case REFP0:  assign(p0.refp, flag(3), after(REFP0), object(kP0, 0)); break;
    case REFP1:  assign(p1.refp, flag(3), after(REFP1), object(kP0, 1)); break;
    case PF0: case PF1: case PF2: write_playfield(write.reg() - PF0, value, cycle); break;
    case RESP0:  strobe_player(0, clock); break;
    case RESP1:  strobe_player(1, clock); break;
    case RESM0:  strobe_missile(0, clock); break;
    case RESM1:  strobe_missile(1, clock); break;
    case RESBL:  strobe_ball(clock); break;
    case GRP0:   write_graphics(0, value, after(GRP0)); break;
    case GRP1:   write_graphics(1, value, after(GRP1)); break;
    case ENAM0:  assign(m0.enabled, flag(1), clock, object(kM0, 0)); control(object(kM0, 0)); break;
    case ENAM1:  assign(m1.enabled, flag(1), clock, object(kM0, 1)); control(object(kM0, 1)); break;
    case ENABL:  write_ball(flag(1), ball.old_enabled, ball.vdel, clock); break;
    case HMP0:   policy_.reach(clock); p0.motion = motion(); break;
    case HMP1:   policy_.reach(clock); p1.motion = motion(); break;
    case HMM0:   write_hmm0(motion(), clock); break;
    case HMM1:   policy_.reach(clock); m1.motion = motion(); break;
    case HMBL:   policy_.reach(clock); ball.motion = motion(); break;
    case VDELP0: write_vdel(0, flag(0), clock); break;
    case VDELP1: write_vdel(1, flag(0), clock); break;
    case VDELBL: write_ball(ball.enabled, ball.old_enabled, flag(0), clock); break;
    case RESMP0: write_resmp(0, flag(1), clock); break;
    case RESMP1: write_resmp(1, flag(1), clock); break;
    case HMOVE:  strobe_hmove(cycle); break;
    case HMCLR:  policy_.reach(clock); p0.motion = p1.motion = m0.motion = m1.motion = ball.motion = 0; break;
    case CXCLR:  clear_collisions(clock); break;
    default:     policy_.reach(clock); break;
  }
  // clang-format on
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_color(unsigned which, std::uint8_t value,
                                                          std::int32_t clock) {
  assign(tia_.color[which], static_cast<std::uint8_t>((value & 0xFE) | color_loss()), clock, kNoObject);
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_nusiz(unsigned which, std::uint8_t value,
                                                          std::int32_t clock) {
  PlayerState& player = tia_.player[which];
  const bool reselects = player.skip || (which == 0 && tia_.cosmic);
  value &= 0x37;
  if (policy_.is_active() && player.nusiz == value && !reselects) return policy_.reach(clock);
  policy_.draw_to(clock, object(kP0, which) | object(kM0, which));
  if (which == 0) end_cosmic_lines(clock);
  player.nusiz = value;
  player.skip = 0;
  if (which == 0) tia_.cosmic_shape = CosmicShape::kNormal;
  policy_.changed(object(kP0, which) | object(kM0, which));
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_ctrlpf(std::uint8_t value, std::int32_t clock) {
  // A later write reflects the playfield only from the next line on.
  const bool latches = line_cycle(clock / 3) < 49;
  const std::uint8_t reflect = latches ? value & 1 : tia_.reflect;
  value &= 0x37;
  if (policy_.is_active() && tia_.ctrlpf == value && tia_.reflect == reflect) return policy_.reach(clock);
  if (latches)
    policy_.draw_to(clock, kBallBit | kPlayfieldBit);
  else
    policy_.advance_to(clock);
  // Drawing may have passed the end of a line, where the latch changes: read it again.
  tia_.reflect = latches ? value & 1 : tia_.reflect;
  tia_.ctrlpf = value;
  policy_.changed(kBallBit | kPlayfieldBit);
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_playfield(unsigned which, std::uint8_t value,
                                                              std::int32_t cycle) {
  static constexpr std::array<std::uint8_t, 4> kDelay = {4, 5, 2, 3};  // to the next block of four pixels
  static_assert(kLineCycles % 4 == 0 && std::ranges::max(kDelay) == kRegisters[PF0].delay);
  const std::int32_t clock = 3 * cycle + kDelay[static_cast<std::size_t>(cycle - first_cycle_) % 4];
  std::uint8_t& reg = tia_.pf[which];
  if (policy_.is_active() && reg == value) {
    policy_.reach(clock);
  } else {
    policy_.draw_before(clock, kPlayfieldParts[tia_.reflect][which]);
    reg = value;
    policy_.changed(kPlayfieldBit);
  }
  control(kPlayfieldBit);
}

// A write to one player's graphics copies the other player's into the register that VDELPx shows.
template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_graphics(unsigned which, std::uint8_t value,
                                                             std::int32_t clock) {
  PlayerState& written = tia_.player[which];
  PlayerState& other = tia_.player[1 - which];
  std::uint8_t objects = kBallBit | object(kP0, 0) | object(kP0, 1);
  if (policy_.is_active()) {
    objects = 0;
    if (!written.vdel && written.grp != value) objects |= object(kP0, which);
    if (other.vdel && other.old_grp != other.grp) objects |= object(kP0, 1 - which);
    if (which == 1 && tia_.ball.vdel && tia_.ball.old_enabled != tia_.ball.enabled) objects |= kBallBit;
  }
  if (objects != 0)
    policy_.draw_to(clock, objects);
  else
    policy_.reach(clock);
  written.grp = value;
  other.old_grp = other.grp;
  if (which == 1) tia_.ball.old_enabled = tia_.ball.enabled;
  control(object(kP0, 0) | object(kP0, 1) | (which == 1 ? kBallBit : 0));
  policy_.changed(objects);
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_vdel(unsigned which, std::uint8_t value,
                                                         std::int32_t clock) {
  assign(tia_.player[which].vdel, value, clock, object(kP0, which));
  control(object(kP0, which));
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_ball(std::uint8_t enabled, std::uint8_t old_enabled,
                                                         std::uint8_t vdel, std::int32_t clock) {
  BallState& ball = tia_.ball;
  const bool is_visible = vdel ? old_enabled != 0 : enabled != 0;
  if (!policy_.is_active() || is_visible != ball_enabled(ball)) {
    policy_.draw_to(clock, kBallBit);
    policy_.changed(kBallBit);
  } else {
    policy_.reach(clock);
  }
  ball.enabled = enabled;
  ball.vdel = vdel;
  control(kBallBit);
}

// A missile that is unlocked stays in the middle of its player.
template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_resmp(unsigned which, std::uint8_t value,
                                                          std::int32_t clock) {
  MissileState& missile = tia_.missile[which];
  const bool unlocks = missile.locked && !value;
  const bool changed = assign(missile.locked, value, clock, object(kM0, which));
  control(object(kM0, which));
  if (!changed || !unlocks) return;
  if (which == 0) end_cosmic_lines(clock);
  const PlayerState& player = tia_.player[which];
  missile.position = wrapped(player.position + 4 * static_cast<int>(kCopies[player.nusiz & 7].scale));
  if (which == 0) show_cosmic_normally();
}

// If HMM0 changes from 7 to 6 exactly 21 cycles after an HMOVE, missile 0 keeps moving: "Cosmic Ark mode".
template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::write_hmm0(std::uint8_t motion, std::int32_t clock) {
  MissileState& missile = tia_.missile[0];
  const bool enters =
      static_cast<std::uint32_t>(clock) == tia_.hmove_clock + 63 && missile.motion == 7 && motion == 6;
  if (enters) {
    policy_.advance_to(clock);
    tia_.cosmic = 1;
    tia_.cosmic_count = 0;
    policy_.changed(object(kM0, 0));
  }
  policy_.reach(clock);
  missile.motion = motion;
}

// In Cosmic Ark mode, the ends of lines move missile 0. Those before `clock` come before its other changes.
template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::end_cosmic_lines(std::int32_t clock) {
  if (tia_.cosmic) policy_.advance_to(clock);
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::show_cosmic_normally() {
  if (tia_.cosmic_shape == CosmicShape::kNormal) return;
  tia_.cosmic_shape = CosmicShape::kNormal;
  policy_.changed(object(kM0, 0));
}

// The position of a missile or of the ball after a strobe: where the beam is, or what docs/spec/tia.md, 8,
// lists for a strobe soon after an HMOVE.
template <ChangePolicy Policy>
RACEBEAM_INLINE std::uint8_t RegisterEffects<Policy>::strobe_position(TiaRegister reg,
                                                                      std::int32_t clock) const {
  struct Exception {
    TiaRegister reg;
    std::uint32_t since_hmove;
    int h;
    std::uint8_t position;
  };
  static constexpr Exception kExceptions[] = {{RESM0, 60, 69, 8},  {RESM1, 9, 18, 3}, {RESBL, 54, 60, 10},
                                              {RESBL, 54, 69, 10}, {RESBL, 9, 18, 3}, {RESBL, 21, 30, 6},
                                              {RESBL, 18, 27, 5}};
  const std::uint32_t since = static_cast<std::uint32_t>(clock) - tia_.hmove_clock;
  const int h = 3 * line_cycle(clock / 3);
  for (const Exception& e : kExceptions)
    if (reg == e.reg && since == e.since_hmove && h == e.h) return e.position;
  return beam_position(h, 2, 4);
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::strobe_player(unsigned which, std::int32_t clock) {
  PlayerState& player = tia_.player[which];
  policy_.draw_to(clock, object(kP0, which));
  const std::uint8_t position = beam_position(3 * line_cycle(clock / 3), 3, 5);
  const int distance = wrapped(position - player.position);
  const Copies& copies = kCopies[player.nusiz & 7];
  const int width = 8 * static_cast<int>(copies.scale);
  bool skip = true;
  for (unsigned i = 0; i < copies.count; ++i) {
    const int into = distance - copies.offset[i];
    if (into >= 0 && into <= 3) skip = false;
    // The old copy is being drawn, and is finished first.
    if (into >= 4 && into <= 3 + width) policy_.draw_to(clock + kRegisters[RESP0].delay, object(kP0, which));
  }
  if (skip) policy_.advance_to(clock);
  player.position = position;
  player.skip = skip;
  policy_.changed(object(kP0, which));
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::strobe_missile(unsigned which, std::int32_t clock) {
  const std::int32_t drawn = clock + kRegisters[RESM0].delay;
  policy_.draw_to(drawn, object(kM0, which));
  if (which == 0) end_cosmic_lines(drawn);
  tia_.missile[which].position = strobe_position(which == 0 ? RESM0 : RESM1, clock);
  if (which == 0) show_cosmic_normally();
  policy_.changed(object(kM0, which));
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::strobe_ball(std::int32_t clock) {
  policy_.draw_to(clock, kBallBit);
  tia_.ball.position = strobe_position(RESBL, clock);
  policy_.changed(kBallBit);
}

template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::strobe_hmove(std::int32_t cycle) {
  const std::int32_t clock = 3 * cycle;
  const int x = line_cycle(cycle);
  const bool arms = video_.hmove_blanks && (x == 75 || x <= 20);
  if (arms)
    policy_.draw_to(clock, kAllObjects);
  else
    policy_.advance_to(clock);
  end_cosmic_lines(clock);
  const auto& movement = kMovement[static_cast<std::size_t>(x)];
  const auto move = [&](std::uint8_t& position, std::uint8_t motion, std::uint8_t objects) {
    if (movement[motion] == 0) return;
    position = wrapped(position + movement[motion]);
    policy_.changed(objects);
  };
  auto& [p0, p1] = tia_.player;
  auto& [m0, m1] = tia_.missile;
  if (movement[0] != 0 || any_motion()) {
    move(p0.position, p0.motion, object(kP0, 0));
    move(p1.position, p1.motion, object(kP0, 1));
    move(m0.position, m0.motion, object(kM0, 0));
    move(m1.position, m1.motion, object(kM0, 1));
    move(tia_.ball.position, tia_.ball.motion, kBallBit);
  }
  if ((p0.skip | p1.skip) != 0) {
    policy_.changed(object(kP0, 0) | object(kP0, 1));
    p0.skip = p1.skip = 0;
  }
  if (arms) tia_.comb_armed = 1;
  tia_.cosmic = 0;
  show_cosmic_normally();
  tia_.hmove_clock = static_cast<std::uint32_t>(clock);
}

// Pixels that are not drawn yet may have collided before the latches are cleared.
template <ChangePolicy Policy>
RACEBEAM_INLINE void RegisterEffects<Policy>::clear_collisions(std::int32_t clock) {
  policy_.collide_to(clock);
  policy_.clear_collisions();
}

}  // namespace racebeam
