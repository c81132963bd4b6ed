// Slows down clients that guess tokens. After a wrong token, tokens from the same address are checked one at
// a time, whatever their connection. Before each there is a delay: 100 ms, doubled with each wrong token in a
// row. Right tokens are delayed, too: an earlier answer would tell which are wrong. Other addresses are never
// delayed, and a delay holds no thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/ip/address.hpp>

namespace racebeam {

// Thread-safe.
class WrongTokens {
 public:
  using Clock = std::chrono::steady_clock;
  using Delay = std::chrono::milliseconds;

  explicit WrongTokens(Delay longest) : longest_(longest) {}

  // What counts as one address: an IPv4 address, or the first 64 bits of an IPv6 address, because one client
  // usually has all of these.
  static std::string source_of(const boost::asio::ip::address& address);

  // The delay of a token from there before the next call of wait(). 0: it may be checked now, and the next
  // one is delayed.
  Delay wait(const std::string& source);
  int count(const std::string& source);     // reports a wrong token; returns how many in a row
  void forgive(const std::string& source);  // reports a right token

 private:
  struct Row {
    int wrong = 0;
    Clock::time_point latest;  // of the last wrong token
    Clock::time_point next;    // when the next token may be checked
  };
  Delay pause(int wrong) const;
  void make_room();

  const Delay longest_;
  std::mutex mutex_;
  std::unordered_map<std::string, Row> rows_;  // by source; old ones are removed
};

// A client that has not sent a right token yet.
class Guesser {
 public:
  Guesser(WrongTokens& all, std::string source) : all_(&all), source_(std::move(source)) {}

  const std::string& source() const { return source_; }
  WrongTokens::Delay wait() { return all_->wait(source_); }

  // wrong: how many of its tokens have been wrong. Returns how many of them are new, and how many there were
  // in a row.
  std::pair<int, int> heard(int wrong);
  void admitted() { all_->forgive(source_); }

 private:
  WrongTokens* all_;
  std::string source_;
  int wrong_ = 0;
};

}  // namespace racebeam
