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

WrongTokens::Delay judge(Client& client, const LineSession& session, Metrics& metrics) {
  const auto [more, in_a_row, delay] = client.guesser->update(session.wrong_tokens());
  metrics.wrong_tokens += more;
  if (more > 0) {
    log_warning(client.name + ": a wrong token from " + client.guesser->source() + ", number " +
                    std::to_string(in_a_row) + " in a row",
                {{"client", client.name}, {"event", "wrong-token"}, {"address", client.guesser->source()}});
  }
  if (session.admitted()) {
    client.guesser->admitted();
    client.guesser.reset();
    client.place.reset();
  }
  return delay;
}

Task<> hold_back(Client& client, WrongTokens::Delay delay) {
  constexpr WrongTokens::Delay kBetweenLooks = 100ms;
  for (const auto end = Clock::now() + delay; Clock::now() < end && !client.ending();)
    co_await pause(client.loop.context, std::min(delay, kBetweenLooks));
}

}  // namespace racebeam
