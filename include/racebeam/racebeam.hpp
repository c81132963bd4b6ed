// All of the library: a machine that plays Atari 2600 games in the process of its caller. Each class
// documents which threads may use it; an agent in each thread, with its own Environment, needs no locks. This
// is a whole agent:
//
//     racebeam::Environment environment(racebeam::Image::load("builtin:beamfall"));
//     int score = 0;
//     while (!environment.episode_over()) score += environment.step(racebeam::Action::kFire);
//     std::cout << score << '\n';
//
// Read environment.hpp first, then settings.hpp and game.hpp; vector.hpp is for agents that learn.
// racebeam/client.hpp is another library: it plays on a server.
#pragma once

#include "racebeam/action.hpp"
#include "racebeam/config.hpp"
#include "racebeam/environment.hpp"
#include "racebeam/error.hpp"
#include "racebeam/game.hpp"
#include "racebeam/image.hpp"
#include "racebeam/settings.hpp"
#include "racebeam/snapshot.hpp"
#include "racebeam/vector.hpp"
#include "racebeam/version.hpp"
