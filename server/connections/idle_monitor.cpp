#include "server/connections/idle_monitor.hpp"

#include <chrono>
#include <string>

#include "server/connections/memory_relief.hpp"
#include "server/operation/log.hpp"
#include "server/scheduling/keep_running.hpp"
#include "server/tuning.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using std::chrono::seconds;
using namespace std::chrono_literals;

std::string why_not_admitted(const Client& client, int handshake_seconds) {
  const std::string time = std::to_string(handshake_seconds) + " seconds";
  if (!client.greeted) return "no handshake came within " + time;
  const bool tried = client.token_attempts && client.token_attempts->wrong() > 0;
  return (tried ? "no right token came within " : "no token came within ") + time;
}

}  // namespace

void IdleMonitor::start() {
  for (Loop& loop : loops_.all())
    keep_running(loop.context, "looking after sessions", [this, &loop] { return monitor(loop); });
}

void IdleMonitor::end_all() {
  for (Loop& loop : loops_.all()) {
    net::post(loop.context, [this, &loop] {
      for (Client* client : loop.clients) {
        ++metrics_.ended_stopping;
        client->end(ErrorCode::kStopping, "the server stops");
      }
    });
  }
}

Task<> IdleMonitor::monitor(Loop& loop) {
  net::steady_timer timer(loop.context);
  MemoryRelief relief(loops_.all().size());
  for (;;) {
    timer.expires_after(tuning::kBetweenIdleLooks);
    co_await timer.async_wait(use_task);
    for (Client* client : loop.clients) check(*client);
    metrics_.ended_busy += relief.relieve(loop.clients);
    if (&loop == &loops_.first()) heap_keeper_.update(metrics_.sessions_open);
    write_log();
  }
}

void IdleMonitor::check(Client& client) {
  const auto now = Clock::now();
  const auto idle = seconds(settings_.idle_seconds), handshake = seconds(settings_.handshake_seconds);
  if (client.ending()) {
    client.end(ErrorCode::kIdle, {});  // disconnects the client, if it has had time to read the error
  } else if (!client.admitted && now - client.connected_at() > handshake) {
    ++metrics_.ended_handshake;
    client.end(ErrorCode::kUnauthorized, why_not_admitted(client, settings_.handshake_seconds));
  } else if (client.working) {
    return;
  } else if (idle > 0s && now - client.last_active() > idle) {
    ++metrics_.ended_idle;
    client.end(ErrorCode::kIdle,
               "nothing came or went for " + std::to_string(settings_.idle_seconds) + " seconds");
  } else if (now - client.last_active() > tuning::kIdlePause) {
    client.release_caches();
  }
}

}  // namespace racebeam
