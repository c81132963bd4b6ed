// Slows down clients that guess tokens. The answer to a wrong token is delayed by 100 ms. The delay doubles
// with each consecutive wrong token from the same address, over any connection. Right tokens are answered at
// once: clients that share an address are not locked out. A delay blocks no thread.
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

  // The unit of counting: an IPv4 address, or the first 64 bits of an IPv6 address, because one client
  // usually has all of these.
  static std::string source_of(const boost::asio::ip::address& address);

  struct Verdict {
    int in_a_row = 0;  // consecutive wrong tokens from the source
    Delay delay{};     // of the answer
  };
  Verdict count(const std::string& source, Clock::time_point now = Clock::now());  // reports a wrong token
  void forgive(const std::string& source);                                         // reports a right token

 private:
  struct Row {
    int wrong = 0;
    Clock::time_point latest;  // of the last wrong token
  };
  Delay pause(int wrong) const;
  void make_room();

  const Delay longest_;
  std::mutex mutex_;
  std::unordered_map<std::string, Row> rows_;  // by source; old ones are removed
};

// A client that has not sent a right token yet.
class TokenAttempts {
 public:
  TokenAttempts(WrongTokens& all, std::string source) : all_(&all), source_(std::move(source)) {}

  const std::string& source() const { return source_; }
  int wrong() const { return wrong_; }  // tokens

  struct Update {
    int more = 0;  // number of wrong tokens since the last call
    int in_a_row = 0;
    WrongTokens::Delay delay{};
  };
  Update update(int wrong);  // wrong: its number of wrong tokens so far
  void admitted() { all_->forgive(source_); }

 private:
  WrongTokens* all_;
  std::string source_;
  int wrong_ = 0;
};

}  // namespace racebeam
