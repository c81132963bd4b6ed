// The connection of an environment to an RL-Glue core. The core is the server of this connection.
#pragma once

#include <cstdint>

#include "protocol/classic/rl_glue.hpp"

namespace racebeam {

constexpr std::uint16_t kRlGluePort = 4096;  // unless the variable RLGLUE_PORT has another

// Waits for the core on this machine and connects to it. Answers until the session is over or the core closes
// the connection. Throws std::runtime_error if the connection is lost in the middle of a message, and
// std::invalid_argument if the core violates the protocol.
void serve_rl_glue(std::uint16_t port, RlGlueEnvironment& environment);

}  // namespace racebeam
