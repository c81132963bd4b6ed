// Measures what the agents of a plan cost on this machine: each plays for a moment (docs/experiments.md).
#pragma once

#include <chrono>

#include "agents/experiment/cost.hpp"
#include "games/images.hpp"

namespace racebeam {

// Measures for about `time`, without the time that agents need to begin. Learners play up to eight times as
// long, since their speed changes as they learn. Games without an image, and games that get no time, have the
// mean of the others. A kind that was not measured is left out.
PlayRates measure_rates(const Plan& plan, const Images& images, std::chrono::duration<double> time);

}  // namespace racebeam
