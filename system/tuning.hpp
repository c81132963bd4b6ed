// Numbers that affect only speed, since they choose between methods with the same result, are rows of a
// tuning table: emulator/policies/tuning.hpp, protocol/tuning.hpp, server/tuning.hpp, and the end of this
// file. The comment before a row says what the number means. `scripts/bench tune` reads the rows, measures
// each at half and at double, and writes docs/performance/tuning.md.
//
//   RACEBEAM_TUNED(type, name, value, unit, measure);
//
// measure: how `scripts/bench tune` measures a row. "frames" and "start" are processor times of games, in the
// middle of play and from power-on. "replies" are the replies of a server. "none": no command measures it.
//
// A row is a constant. In a build with RACEBEAM_TUNABLE, which only that command makes, a row takes another
// value from the environment variable RACEBEAM_TUNING, as in "kMaxWork=50 kLongestRun=64".
#pragma once

#ifdef RACEBEAM_TUNABLE

#include <cstdint>
#include <cstdlib>
#include <string>

namespace racebeam::tuning {

template <class T>
T tuned(const std::string& name, T usual) {
  const char* const variable = std::getenv("RACEBEAM_TUNING");
  const std::string values = std::string(" ") + (variable != nullptr ? variable : "");
  const auto found = values.find(" " + name + "=");
  if (found == std::string::npos) return usual;
  return static_cast<T>(static_cast<std::int64_t>(std::atoll(values.c_str() + found + name.size() + 2)));
}

}  // namespace racebeam::tuning

#define RACEBEAM_TUNED(type, name, value, unit, measure) \
  inline const type name = tuned<type>(#name, type(value))

#else

#define RACEBEAM_TUNED(type, name, value, unit, measure) inline constexpr type name(value)

#endif

namespace racebeam::tuning {

// The most busy polls (busy_poll.hpp) that are skipped after polls in vain.
RACEBEAM_TUNED(int, kMaxSkippedPolls, 1024, "polls", "none");

}  // namespace racebeam::tuning
