// A connected client and its session's bookkeeping.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>  // needed by Asio 1.74

#include <boost/asio.hpp>

#include "protocol/request_error.hpp"
#include "protocol/running/memory_budget.hpp"
#include "server/access/wrong_tokens.hpp"
#include "server/connections/lobby.hpp"
#include "server/scheduling/loops.hpp"

namespace racebeam {

using Protocol = boost::asio::generic::stream_protocol;
using Socket = Protocol::socket;
using Clock = std::chrono::steady_clock;

// Counts as a session of its loop during its lifetime. Members that are not const are used on the loop's
// thread only.
class Client {
 public:
  // The budget is charged with `bytes` for the transport of the session: a socket, TLS, HTTP. It may be null.
  Client(Socket connection, Loop& home, std::string who, const std::shared_ptr<MemoryBudget>& budget,
         std::size_t bytes);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void enter_loop();  // adds this client to the loop's clients
  void leave_loop();

  void mark_active() {
    active_ = Clock::now();
    caches_released_ = false;
  }
  void received(std::size_t bytes);
  void sent(std::size_t bytes);

  // Ends the session: cancels what it waits for, so that it sends the error to the client. If the client has
  // not read the error within two seconds, the next call of end() disconnects it.
  void end(ErrorCode code, const std::string& sentence);
  bool ending() const { return !farewell_.empty(); }
  const std::string& farewell() const { return farewell_; }  // a reply of the line protocol
  ErrorCode code() const { return code_; }                   // of the farewell
  const std::string& reason() const { return reason_; }      // for the log

  // The session's part of the budget of its owner, which is a user of this machine, or an address. Null if
  // memory is unlimited.
  const std::shared_ptr<MemoryBudget>& memory() const { return budget_; }

  // A reply of this many bytes is being sent. sent() reports how many were sent.
  void begin_sending(std::size_t bytes);
  std::size_t unsent() const { return unsent_; }
  Clock::time_point sends_since() const { return sends_since_; }  // while there are unsent bytes

  // The client is idle. In each pause, the first call makes the session release its caches.
  void release_caches();
  std::function<void()> on_idle;  // empty if the session has no caches

  Clock::time_point connected_at() const { return connected_at_; }
  Clock::time_point last_active() const { return active_; }  // when bytes were last received or sent

  Socket socket;
  Loop& loop;
  const std::string name;
  std::optional<Counted> open, admitted_open;   // count the session in the metrics while it is open
  std::optional<TokenAttempts> token_attempts;  // while a token is required
  std::optional<Lobby::Place> place;            // while a token is required
  bool greeted = false;                         // the handshakes of TLS and HTTP are done
  bool admitted = false;                        // it has given its token, or does not need one
  bool working = false;                         // a slice of its requests is done, and the next is pending
  Usage usage{};                                // how long it has used the event loop

 private:
  const std::shared_ptr<MemoryBudget> budget_;
  MemoryShare carrier_;
  std::size_t unsent_ = 0;
  Clock::time_point sends_since_{};
  Clock::time_point connected_at_ = Clock::now(), active_ = connected_at_, ended_{};
  bool caches_released_ = false;
  bool quick_ = false;  // its next request came at once
  ErrorCode code_{};
  std::string farewell_, reason_;
};

}  // namespace racebeam
