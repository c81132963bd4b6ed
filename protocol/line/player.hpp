// One machine with a game, and what its client sees of it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "environment/input/noops.hpp"
#include "games/catalogue.hpp"
#include "protocol/line/action.hpp"
#include "protocol/line/field.hpp"
#include "protocol/line/play_settings.hpp"
#include "protocol/running/pacer.hpp"

namespace racebeam {

// A place that can be returned to: the machine, and the stack of small screens if there was one.
struct Place {
  std::shared_ptr<const Environment::Saved> machine;
  std::vector<std::uint8_t> stack;
  bool with_random = false;  // the generator of what is random in play is part of it
  bool blends = false;       // as Player::blends()

  std::size_t footprint() const;  // bytes of memory, about; pictures that are shared count
};

class Player {
 public:
  // Powers on, sets mode and difficulty, and begins an episode. Throws InvalidInput, and what
  // `pacer` throws, which outlives the player.
  Player(const Cartridge& cartridge, const PlaySettings& settings, std::vector<Field> fields, Pacer& pacer);

  Pacer& pacer() { return pacer_; }
  Environment& machine() { return machine_; }
  const Environment& machine() const { return machine_; }
  AllowedActions allowed() const { return {machine_.game().name, allowed_}; }

  void begin_request();            // sums begin at 0
  void act(const Action& action);  // once, whatever its `times`
  void reset();                    // and no-ops, as the settings have it; what throws leaves all as it was
  std::int64_t reset_frames() const { return reset_frames_; }  // that the longest reset so far has run
  const Outcome& outcome() const { return outcome_; }
  void set_outcome(const Outcome& outcome) { outcome_ = outcome; }

  // Whether a small screen is made of the last two frames, or of the last alone: the last act ran one only,
  // or what was before is unknown.
  bool blends() const { return blends_; }

  Place place(bool with_random) const;
  void go_to(const Place& place);  // throws InvalidInput

  // Bytes of memory, about, of a player with these fields.
  static std::size_t footprint(const std::vector<Field>& fields);

  void observe(std::vector<Field> fields);
  View& view() { return view_; }
  void append_view(std::string& out) { view_.append(out, machine_, outcome_); }

 private:
  void begin_episode();
  void look_at_ends();

  Pacer& pacer_;
  Environment machine_;
  std::uint32_t allowed_ = 0;  // bit n: action n
  Noops noops_;                // with a generator of its own, as in the reference; no part of a state
  Outcome outcome_;
  std::int64_t reset_frames_ = 0;
  bool blends_ = false;
  mutable View view_;
};

}  // namespace racebeam
