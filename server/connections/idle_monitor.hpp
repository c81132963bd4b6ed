// Examines all sessions from time to time, so that a session does not need its own timer. Ends sessions that
// are idle, and those that have not given a token in time.
#pragma once

#include "server/connections/client.hpp"
#include "server/connections/settings.hpp"
#include "server/operation/heap_keeper.hpp"

namespace racebeam {

class IdleMonitor {
 public:
  // The parameters must outlive it.
  IdleMonitor(const ServerSettings& settings, Loops& loops, Metrics& metrics)
      : settings_(settings), loops_(loops), metrics_(metrics) {}

  void start();    // starts a task on each loop
  void end_all();  // ends all sessions because the server stops

 private:
  Task<> monitor(Loop& loop);
  void check(Client& client);

  const ServerSettings& settings_;
  Loops& loops_;
  Metrics& metrics_;
  HeapKeeper heap_keeper_;  // used on the first loop's thread
};

}  // namespace racebeam
