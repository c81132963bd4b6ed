#include "server/connections/memory_relief.hpp"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace racebeam {
namespace {

using namespace std::chrono_literals;

// These do not affect speed only, so they are not rows of a tuning table: they say who loses a session or its
// caches when memory is short, and server/README.md, "Memory", promises them.
constexpr auto kPause = 250ms;   // after which a session releases its caches
constexpr auto kLongPause = 2s;  // after which a session may be ended
constexpr auto kSlow = 1s;       // the longest time that a client which reads takes for a reply
constexpr std::size_t kOnItsWay = std::size_t{64} << 10;  // bytes; a client that reads has no more unsent

enum class Burden { kNone, kActive, kIdle, kUnread };  // sessions with the last of these are ended first

bool holds_the_mean(const MemoryBudget& part) {
  const MemoryBudget& whole = *part.whole();
  return part.taken() * whole.parts() >= whole.taken();
}

Burden burden_of(const Client& client, Clock::time_point now) {
  if (client.ending() || client.memory() == nullptr) return Burden::kNone;
  if (client.unsent() > kOnItsWay && now - client.sends_since() > kSlow) return Burden::kUnread;
  const MemoryBudget& session = *client.memory();
  const MemoryBudget& owner = *session.whole();
  if (!holds_the_mean(session) || !holds_the_mean(owner)) return Burden::kNone;
  if (!client.working && now - client.last_active() > kLongPause) return Burden::kIdle;
  // An owner whose busy sessions hold most of the memory loses some of them, so that others have room.
  return owner.crowds_others_out() ? Burden::kActive : Burden::kNone;
}

}  // namespace

Client* most_burdensome(const std::unordered_set<Client*>& clients, Clock::time_point now) {
  Client* found = nullptr;
  std::tuple<Burden, std::uint64_t, std::uint64_t> most;
  for (Client* client : clients) {
    const Burden burden = burden_of(*client, now);
    if (burden == Burden::kNone) continue;
    const std::tuple weight(burden, burden == Burden::kUnread ? 0 : client->memory()->whole()->taken(),
                            client->memory()->taken());
    if (found == nullptr || weight > most) std::tie(found, most) = std::tie(client, weight);
  }
  return found;
}

int MemoryRelief::relieve(const std::unordered_set<Client*>& clients) {
  if (clients.empty() || (*clients.begin())->memory() == nullptr) return 0;
  const MemoryBudget& all = (*clients.begin())->memory()->all();
  const auto now = Clock::now();
  if (!all.is_short()) return was_short_ = false, 0;
  for (Client* client : clients) {
    if (!client->working && now - client->last_active() > kPause) client->release_caches();
  }
  if (!std::exchange(was_short_, true)) return 0;  // sessions take a moment to release their caches
  int ended = 0;
  for (std::uint64_t excess = all.shortage() / loops_ + 1; excess > 0; ++ended) {
    Client* const client = most_burdensome(clients, now);
    if (client == nullptr) break;
    excess -= std::min(excess, client->memory()->taken());
    client->end(ErrorCode::kBusy, "the server needs the memory that this session holds");
  }
  return ended;
}

}  // namespace racebeam
