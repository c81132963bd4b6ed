// Makes room when the memory of the sessions is short. First, idle sessions release what they can recreate.
// If that is not enough, some sessions are ended. The first are those whose clients do not read their
// replies. Then come idle sessions that hold much memory, those of the owners that hold most first.
#pragma once

#include <unordered_set>

#include "server/connections/client.hpp"

namespace racebeam {

class MemoryRelief {
 public:
  // loops: the number of loops among which the sessions are divided; each relieves the memory of its part.
  explicit MemoryRelief(std::size_t loops) : loops_(loops) {}

  // The caller calls it a few times a second, on the thread of the loop that has the clients. Returns how
  // many sessions it has ended.
  int relieve(const std::unordered_set<Client*>& clients);

 private:
  const std::size_t loops_;
  bool was_short_ = false;
};

// Returns the client whose session is ended first; null if none may be ended. A session whose client
// reads is exempt if it holds less than the mean of its owner's sessions, or if its owner holds less than the
// mean of all owners.
Client* most_burdensome(const std::unordered_set<Client*>& clients, Clock::time_point now);

}  // namespace racebeam
