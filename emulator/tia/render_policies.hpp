// Policies that RegisterEffects calls before and after each change of a register: two draw, one only computes
// collisions, and one replays writes of a line whose pixels exist.
//
// Before a change:
// - draw_to(clock, objects): these objects (bit n: Object n), or colours, change at `clock`.
// - draw_before(clock, part): the same for a part of the playfield.
// - advance_to(clock): the ends of lines before `clock` must be processed, too.
// - collide_to(clock): the latches are read or cleared at `clock`.
// - reach(clock): the beam is at `clock`; nothing changes.
// After a change:
// - changed(objects): registers of these objects have changed.
// - enabled_changed(): TiaRegisters::enabled or VBLANK may have changed.
// Questions:
// - tracks(objects): whether it matters if one of these objects is enabled.
// - is_active(): while false, the policy may ignore all calls. Its user then updates TiaRegisters::enabled
//   afterwards.
#pragma once

#include <cstdint>

#include "emulator/base/inlining.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/beam.hpp"
#include "emulator/tia/line/objects.hpp"

namespace racebeam {

// Draws the pixels before each change.
struct RenderPolicy {
  Beam& beam;
  std::int32_t& reached;

  RACEBEAM_INLINE void reach(std::int32_t clock) const { reached = clock > reached ? clock : reached; }
  RACEBEAM_INLINE void draw_to(std::int32_t clock, unsigned) const { advance_to(clock); }
  RACEBEAM_INLINE void draw_before(std::int32_t clock, const PlayfieldPart& part) const {
    reach(clock);
    beam.draw_before(reached, part);
  }
  RACEBEAM_INLINE void advance_to(std::int32_t clock) const {
    reach(clock);
    beam.draw_to(reached);
  }
  RACEBEAM_INLINE void collide_to(std::int32_t clock) const {
    reach(clock);
    beam.collide_to(reached);
  }
  static constexpr bool is_active() { return true; }
  static constexpr bool tracks(unsigned) { return true; }
  RACEBEAM_INLINE void changed(std::uint8_t objects) const { beam.changed(objects); }
  RACEBEAM_INLINE void enabled_changed() const {}
  RACEBEAM_INLINE void clear_collisions() const { beam.clear_collisions(); }
};

// Draws the rest of a line, all of whose writes are known.
struct LinePolicy : RenderPolicy {
  RACEBEAM_INLINE void draw_to(std::int32_t clock, unsigned) const { advance_to(clock); }
  RACEBEAM_INLINE void draw_before(std::int32_t clock, const PlayfieldPart& part) const {
    reach(clock);
    beam.draw_before_on_line(reached, part);
  }
  RACEBEAM_INLINE void advance_to(std::int32_t clock) const {
    reach(clock);
    beam.draw_on_line(reached);
  }
};

// Computes collisions without pixels. The beam stays behind, except while objects are shown that may meet.
struct TrackPolicy {
  Beam& beam;
  TiaState& tia;
  std::int32_t& reached;
  bool& watches;
  const unsigned sought = beam.sought_objects();

  RACEBEAM_INLINE void reach(std::int32_t clock) const { reached = clock > reached ? clock : reached; }
  RACEBEAM_INLINE bool is_active() const { return watches; }
  RACEBEAM_INLINE void draw_to(std::int32_t clock, unsigned objects) const {
    reach(clock);
    if (watches && (objects & sought) != 0) beam.draw_to(reached);
  }
  RACEBEAM_INLINE void draw_before(std::int32_t clock, const PlayfieldPart&) const {
    draw_to(clock, object_bit(kPlayfield));
  }
  RACEBEAM_INLINE void collide_to(std::int32_t clock) const { draw_to(clock, kAllObjects); }
  RACEBEAM_INLINE bool tracks(unsigned objects) const { return (sought & objects) != 0; }
  RACEBEAM_INLINE void advance_to(std::int32_t clock) const {
    reach(clock);
    if (watches)
      beam.draw_to(reached);
    else
      beam.pass_to(reached);
  }
  RACEBEAM_INLINE void changed(std::uint8_t objects) const { beam.changed(objects); }
  RACEBEAM_INLINE void enabled_changed() const {
    const bool watched = watches;
    watches = beam.may_meet() || tia.cosmic;
    if (watches && !watched) beam.pass_to(reached);
  }
  RACEBEAM_INLINE void clear_collisions() const {
    beam.clear_collisions();
    enabled_changed();
  }
};

// The line's pixels exist; only the registers are needed.
struct ReplayPolicy {
  Beam& beam;

  RACEBEAM_INLINE void reach(std::int32_t) const {}
  RACEBEAM_INLINE void draw_to(std::int32_t, unsigned) const {}
  RACEBEAM_INLINE void draw_before(std::int32_t, const PlayfieldPart&) const {}
  RACEBEAM_INLINE void collide_to(std::int32_t) const {}
  static constexpr bool is_active() { return false; }
  RACEBEAM_INLINE void advance_to(std::int32_t) const {}
  static constexpr bool tracks(unsigned) { return false; }
  RACEBEAM_INLINE void enabled_changed() const {}
  RACEBEAM_INLINE void changed(std::uint8_t objects) const { beam.changed(objects); }
  RACEBEAM_INLINE void clear_collisions() const { beam.clear_collisions(); }
};

}  // namespace racebeam
