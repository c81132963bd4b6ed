// The admission of a client: the first right token admits it, and the answers to wrong ones are delayed.
#pragma once

#include "protocol/line_session.hpp"
#include "server/connections/client.hpp"

namespace racebeam {

void count_admission(Client& client, Metrics& metrics);  // once for each client

// For a client that needs a token. Counts the wrong tokens that the session has seen since the last call.
// Returns for how long the answer is delayed.
WrongTokens::Delay update_admission(Client& client, const LineSession& session, Metrics& metrics);

// Delays the answer to a wrong token, and the requests that the client has sent after it. Returns early if
// the session is to end.
Task<> delay_requests(Client& client, WrongTokens::Delay delay);

}  // namespace racebeam
