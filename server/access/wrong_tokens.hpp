// Slows down clients that guess tokens. After a wrong token, tokens from the same address are looked at one
// at a time, whatever connections they come over, with a pause before each: 100 ms, then twice as long with
// each wrong token in a row. Right tokens wait alike, since an answer that comes sooner would tell which are
// wrong. Other addresses never wait, and waiting keeps no thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio/ip/address.hpp>

namespace racebeam {

// From any thread.
class WrongTokens {
 public:
  using Clock = std::chrono::steady_clock;
  using Delay = std::chrono::milliseconds;

  explicit WrongTokens(Delay longest) : longest_(longest) {}

  // What counts as one address: one of IPv4, or the first 64 bits of one of IPv6, which one client has for
  // itself.
  static std::string source_of(const boost::asio::ip::address& address);

  // How long a token from there has to wait before it may ask again. 0: it may be looked at now, and the next
  // one has to wait for the pause after it.
  Delay wait(const std::string& source);
  int count(const std::string& source);     // one was wrong; how many in a row
  void forgive(const std::string& source);  // one was right

 private:
  struct Row {
    int wrong = 0;
    Clock::time_point latest;  // that one was wrong
    Clock::time_point next;    // that one may be looked at
  };
  Delay pause(int wrong) const;
  void make_room();

  const Delay longest_;
  std::mutex mutex_;
  std::unordered_map<std::string, Row> rows_;  // by source; those of long ago are forgotten
};

// One client that has not shown a right token yet.
class Guesser {
 public:
  Guesser(WrongTokens& all, std::string source) : all_(&all), source_(std::move(source)) {}

  const std::string& source() const { return source_; }
  WrongTokens::Delay wait() { return all_->wait(source_); }

  // So many of its tokens have been wrong by now. Returns how many are new, and how many there were in a row.
  std::pair<int, int> heard(int wrong);
  void admitted() { all_->forgive(source_); }

 private:
  WrongTokens* all_;
  std::string source_;
  int wrong_ = 0;
};

}  // namespace racebeam
