// Looks after sessions from time to time, so that none costs a timer of its own: idle ones, and those that do
// not show that they may play, are ended.
#pragma once

#include <utility>  // Asio 1.74 forgets it

#include <boost/asio/awaitable.hpp>

#include "server/connections/client.hpp"
#include "server/connections/settings.hpp"

namespace racebeam {

class IdleMonitor {
 public:
  IdleMonitor(const ServerSettings& settings, Loops& loops, Metrics& metrics)  // which outlive it
      : settings_(settings), loops_(loops), metrics_(metrics) {}

  void start();    // on each loop
  void end_all();  // the server stops

 private:
  boost::asio::awaitable<void> look_after(Loop& loop);
  void look_at(Client& client);

  const ServerSettings& settings_;
  Loops& loops_;
  Metrics& metrics_;
};

}  // namespace racebeam
