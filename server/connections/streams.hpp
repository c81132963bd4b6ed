// One session over a pair of byte streams that were there before us: standard streams, named pipes.
// They may be of any kind, files too, so that reading and writing simply block, on a thread of their own.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "server/access/address.hpp"
#include "server/connections/blocking_pair.hpp"
#include "server/connections/service.hpp"
#include "server/operation/metrics.hpp"

namespace racebeam {

class StreamSession {
 public:
  // Makes pipes that are missing and what the session needs, so that who starts the server hears at once when
  // it can't be had: throws std::runtime_error or std::invalid_argument. All outlive the session.
  StreamSession(const Endpoint& endpoint, const Service& service, std::chrono::microseconds busy_poll,
                Metrics& metrics);
  ~StreamSession();
  StreamSession(const StreamSession&) = delete;
  StreamSession& operator=(const StreamSession&) = delete;

  const std::string& name() const { return name_; }

  // Serves, on a thread; calls `ended` there when all is over.
  void start(std::function<void()> ended);

  bool ended() const { return ended_; }
  int status() const { return status_; }  // of the process, once ended: see the help of racebeam serve

  // No further request is read; one that is under way is finished. To be called until ended(): each call
  // wakes the thread up, if it waits. With `at_once`, what is under way is given up.
  void stop(bool at_once);

 private:
  class Conversation;
  class LineConversation;
  class ClassicConversation;

  void run();
  bool connect();

  Address address_;
  std::string name_;
  Metrics& metrics_;
  Halt halt_;
  BlockingPair streams_;
  std::unique_ptr<Conversation> conversation_;
  std::atomic<bool> ended_ = false;
  std::atomic<int> status_ = 0;
  std::function<void()> on_end_;
  std::thread thread_;
};

}  // namespace racebeam
