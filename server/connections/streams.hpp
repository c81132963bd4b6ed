// One session over a pair of existing byte streams: standard streams or named pipes. They may be of any kind,
// including files. Reads and writes therefore block, on their own thread.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "server/access/address.hpp"
#include "server/connections/service.hpp"
#include "server/operation/metrics.hpp"
#include "server/operation/unlink_on_exit.hpp"
#include "system/program/blocking_pair.hpp"
#include "system/program/gate.hpp"

namespace racebeam {

class StreamSession {
 public:
  // Creates missing pipes, and what the session needs, so that errors appear at the start. Throws
  // std::runtime_error or std::invalid_argument. All parameters must outlive the session.
  StreamSession(const Endpoint& endpoint, const Service& service, std::chrono::microseconds busy_poll,
                Metrics& metrics);
  ~StreamSession();
  StreamSession(const StreamSession&) = delete;
  StreamSession& operator=(const StreamSession&) = delete;

  const std::string& name() const { return name_; }

  // Starts a thread, which waits for begin(), serves, and calls `ended` at the end. Throws std::system_error
  // if the system does not have a thread.
  void start(std::function<void()> ended);
  void begin();

  bool ended() const { return ended_; }
  int status() const { return status_; }  // of the process, at the end: see the help of racebeam serve

  // Stops the session: it does not read more requests. It finishes the request in progress, or cancels it
  // with `at_once`. The caller calls stop() repeatedly until ended(), since each call wakes the thread if it
  // blocks.
  void stop(bool at_once);

 private:
  class Conversation;
  class LineConversation;
  class ClassicConversation;

  void run();
  void serve();
  bool connect();

  Address address_;
  std::string name_;
  Metrics& metrics_;
  Halt halt_;
  BlockingPair streams_;
  std::vector<UnlinkOnExit> made_;  // the pipes that the server has made
  std::unique_ptr<Conversation> conversation_;
  std::atomic<bool> ended_ = false;
  std::atomic<int> status_ = 0;
  std::function<void()> on_end_;
  Gate beginning_;
  std::jthread thread_;
};

}  // namespace racebeam
