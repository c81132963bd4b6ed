// Somebody who came in over a socket.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio.hpp>

#include "protocol/refusal.hpp"
#include "server/connections/lobby.hpp"
#include "server/access/wrong_tokens.hpp"
#include "server/scheduling/loops.hpp"

namespace racebeam {

using Protocol = boost::asio::generic::stream_protocol;
using Socket = Protocol::socket;
using Clock = std::chrono::steady_clock;

// Counts as a session of its loop until the end. What is not const is touched on the loop's thread only.
class Client {
 public:
  Client(Socket connection, Loop& home, std::string who);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void came_in();  // to the loop's clients
  void left();

  void is_active() {
    active_ = Clock::now();
    rests_ = false;
  }
  void received(std::size_t bytes);
  void sent(std::size_t bytes);
  bool sleeps() const { return sleeps_; }  // before its reply is there: the last took long

  // Ends the session: what it waits for is cancelled, and it is told why. One that does not take the news
  // within two seconds is cut off by the next end().
  void end(Code code, const std::string& sentence);
  bool ending() const { return !farewell_.empty(); }
  const std::string& farewell() const { return farewell_; }  // a reply of the line protocol
  const std::string& reason() const { return reason_; }      // for the log

  // Once in each pause: the session gives back what memory it can.
  void rest();
  std::function<void()> on_rest;  // empty: there is nothing to give back

  Clock::time_point came() const { return came_; }
  Clock::time_point active() const { return active_; }  // when something came or went

  Socket socket;
  Loop& loop;
  const std::string name;
  std::optional<Guesser> guesser;     // as long as a token is needed
  std::optional<Lobby::Place> place;  // the same
  bool admitted = false;              // has shown what is needed to play
  bool held_back = false;             // its token waits, for wrong ones from the same address
  bool working = false;  // it waits for us: a slice of its requests is done, the next has yet to come
  Usage usage;           // of the loop

 private:
  Clock::time_point came_ = Clock::now(), active_ = came_, ended_{};
  bool rests_ = false;
  bool quick_ = false;  // it asked again at once
  bool sleeps_ = false;
  std::string farewell_, reason_;
};

}  // namespace racebeam
