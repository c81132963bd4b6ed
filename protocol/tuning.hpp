// The tuning table of a session: the numbers that decide when it reads the clock, and when it sends replies
// (system/tuning.hpp, docs/performance/tuning.md).
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "system/tuning.hpp"

namespace racebeam::tuning {

// Slices of a request (running/pacer.hpp). Reading the clock takes 25 ns, a frame from 2 us to some
// milliseconds.

// Frames after which a session looks at the clock again.
RACEBEAM_TUNED(int, kFramesBetweenLooks, 4, "frames", "replies");
// If the frames between two looks at the clock take longer than this, the session looks after each frame.
RACEBEAM_TUNED(std::chrono::microseconds, kLongBetweenLooks, 400, "us", "replies");

// Replies to requests that were sent ahead are sent together (line/session.cpp).

// Replies are sent when they have taken this many frames: some hundred microseconds.
RACEBEAM_TUNED(std::int64_t, kFramesOfReplies, 64, "frames", "replies");
// Replies are sent when they have this many bytes: about twenty screens.
RACEBEAM_TUNED(std::size_t, kBytesOfReplies, 65536, "bytes", "replies");
// Replies are also sent when this many requests are left. The client reads them meanwhile, and sends the
// next requests.
RACEBEAM_TUNED(std::size_t, kLastRequests, 3, "requests", "replies");
// With fewer replies than this, the session waits for the last ones: they are not worth waking the client
// twice.
RACEBEAM_TUNED(std::int64_t, kFewReplies, 4, "replies", "replies");

}  // namespace racebeam::tuning
