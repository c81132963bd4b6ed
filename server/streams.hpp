// One session over a pair of byte streams that were there before us: standard streams, named pipes.
// They may be of any kind, files too, so that reading and writing simply block.
#pragma once

#include <string>

#include "server/service.hpp"

namespace racebeam {

// All return the exit status of the process; SIGTERM and SIGINT end the session and the process with status
// 0.
int serve_standard_streams(const Service& service);

// The server writes to PREFIX_out and reads from PREFIX_in. Both are made if they are missing, and left
// behind.
int serve_pipes(const std::string& prefix, const Service& service);

// The same with ale_fifo_out and ale_fifo_in, which the client makes: when ale_fifo_out is missing the
// classic server writes a plain file of that name, and when ale_fifo_in is missing it ends.
int serve_classic_pipes(const ClassicService& service);

}  // namespace racebeam
