#include "server/connections/memory_relief.hpp"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace racebeam {
namespace {

using namespace std::chrono_literals;

constexpr auto kPause = 250ms;                            // of a session that is told to release its caches
constexpr auto kLongPause = 2s;                           // of one that may be ended
constexpr auto kSlow = 1s;                                // of a client that reads, for one reply
constexpr std::size_t kOnItsWay = std::size_t{64} << 10;  // bytes; more is not being read

enum class Burden { kNone, kActive, kIdle, kUnread };  // the later, the sooner it is ended

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
  if (!client.working && now - client.active() > kLongPause) return Burden::kIdle;
  // An owner that holds most of the memory with sessions that are busy loses some of them, for others' sake.
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

int MemoryRelief::look_at(const std::unordered_set<Client*>& clients) {
  if (clients.empty() || (*clients.begin())->memory() == nullptr) return 0;
  const MemoryBudget& all = (*clients.begin())->memory()->all();
  const auto now = Clock::now();
  if (!all.is_short()) return was_short_ = false, 0;
  for (Client* client : clients) {
    if (!client->working && now - client->active() > kPause) client->rest();
  }
  if (!std::exchange(was_short_, true)) return 0;  // what rests takes a moment to go
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
