/// @file
/// The client of the racebeam line protocol: it plays on a server, which launch() starts or connect() finds.
/// Threads may share a Session, where each request gets its own reply; one coroutine at a time uses an
/// AsyncSession.
///
///     auto game = racebeam::client::launch();  // the program racebeam
///     game.load("beamfall", "seed=7", "frame_skip=4");
///     game.observe("reward", "terminated", "truncated");
///     long score = 0;
///     for (int step = 0; step < 100; ++step) score += game.act("FIRE").reward();
///     std::cout << "score " << score << '\n';
#pragma once

#include "racebeam/client/async_session.hpp"
#include "racebeam/client/session.hpp"
