// Makes room when the memory of the sessions is short. First, idle sessions release what they can recreate.
// If that is not enough, some are ended: clients that do not read their replies, then sessions that wait and
// hold much, of the owners that hold most.
#pragma once

#include <unordered_set>

#include "server/connections/client.hpp"

namespace racebeam {

class MemoryRelief {
 public:
  // loops: the number of loops among which the sessions are divided; each relieves the memory of its part.
  explicit MemoryRelief(std::size_t loops) : loops_(loops) {}

  // Call it a few times a second, on the thread of the loop that has the clients. Returns how many it has
  // ended.
  int look_at(const std::unordered_set<Client*>& clients);

 private:
  const std::size_t loops_;
  bool was_short_ = false;
};

// The session to end first; null: none is to end. Never those that hold less than the mean of their owner's
// sessions, or whose owner holds less than the mean of all owners, unless they do not read.
Client* most_burdensome(const std::unordered_set<Client*>& clients, Clock::time_point now);

}  // namespace racebeam
