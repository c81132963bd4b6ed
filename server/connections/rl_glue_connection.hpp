// The connection of an environment to an RL-Glue core, which is the server there.
#pragma once

#include <cstdint>

#include "protocol/classic/rl_glue.hpp"

namespace racebeam {

constexpr std::uint16_t kRlGluePort = 4096;  // unless the variable RLGLUE_PORT has another

// Connects to the core on this machine, which it waits for, and answers until the session is over or the core
// closes the connection. Throws std::runtime_error if the connection is lost in the middle of a message, and
// std::invalid_argument if the core sends what the protocol does not have.
void serve_rl_glue(std::uint16_t port, RlGlueEnvironment& environment);

}  // namespace racebeam
