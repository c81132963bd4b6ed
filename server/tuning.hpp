// The tuning table of the server: the numbers by which an event loop divides its time among sessions
// (system/tuning.hpp, docs/performance/tuning.md). The time for which a loop polls is not here: it is an
// option, `--busy-poll`.
#pragma once

#include <chrono>

#include "system/tuning.hpp"

namespace racebeam::tuning {

// Turns of sessions (scheduling/turns.hpp).

// The time by which a session that comes back after a pause is preferred to others.
RACEBEAM_TUNED(std::chrono::microseconds, kCreditOfPause, 250, "us", "none");
// The shortest slice, however many sessions wait.
RACEBEAM_TUNED(std::chrono::microseconds, kShortestSlice, 250, "us", "none");
// The longest slice, if no other session waits.
RACEBEAM_TUNED(std::chrono::microseconds, kLongestSlice, 2000, "us", "none");
// What a slice costs in addition to its work: to receive and to send.
RACEBEAM_TUNED(std::chrono::microseconds, kCostOfSlice, 20, "us", "none");
// A session is charged at most this many slices for one. More time was another program's.
RACEBEAM_TUNED(int, kMostCharged, 2, "slices", "none");
// The time of a round of slices, one for each session that waits.
RACEBEAM_TUNED(std::chrono::microseconds, kRoundOfSlices, 16'000, "us", "none");

// For how long a loop handles events between two turns (scheduling/loops.cpp).
RACEBEAM_TUNED(std::chrono::microseconds, kLongestEvents, 2000, "us", "none");

// Idle sessions (connections/idle_monitor.cpp).

// Time between two looks at the connections.
RACEBEAM_TUNED(std::chrono::milliseconds, kBetweenIdleLooks, 250, "ms", "none");
// If a client sends no request for this time, its session releases its caches.
RACEBEAM_TUNED(std::chrono::milliseconds, kIdlePause, 2000, "ms", "none");

}  // namespace racebeam::tuning
