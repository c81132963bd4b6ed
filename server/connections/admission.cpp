#include "server/connections/admission.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "server/operation/log.hpp"
#include "server/scheduling/keep_running.hpp"

namespace racebeam {

using namespace std::chrono_literals;

void count_admission(Client& client, Metrics& metrics) {
  if (std::exchange(client.admitted, true)) return;
  client.admitted_open.emplace(metrics.admitted_open);
  ++metrics.admitted;
}

WrongTokens::Delay update_admission(Client& client, const LineSession& session, Metrics& metrics) {
  const auto [more, in_a_row, delay] = client.token_attempts->update(session.wrong_tokens());
  metrics.wrong_tokens += more;
  if (more > 0) {
    log_warning(
        client.name + ": a wrong token from " + client.token_attempts->source() + ", number " +
            std::to_string(in_a_row) + " in a row",
        {{"client", client.name}, {"event", "wrong-token"}, {"address", client.token_attempts->source()}});
  }
  if (session.admitted()) {
    client.token_attempts->admitted();
    client.token_attempts.reset();
    client.place.reset();
  }
  return delay;
}

Task<> delay_requests(Client& client, WrongTokens::Delay delay) {
  constexpr WrongTokens::Delay kBetweenLooks = 100ms;
  for (const auto end = Clock::now() + delay; Clock::now() < end && !client.ending();)
    co_await pause(client.loop.context, std::min(delay, kBetweenLooks));
}

}  // namespace racebeam
