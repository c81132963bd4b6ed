#include "server/access/wrong_tokens.hpp"

#include <algorithm>

namespace racebeam {
namespace {

namespace ip = boost::asio::ip;
using namespace std::chrono_literals;

constexpr auto kFirstDelay = 100ms;
constexpr auto kMemory = 10min;  // how long a wrong token is remembered
constexpr std::size_t kMaxSources = 4096;
constexpr int kMaxDoublings = 16;

}  // namespace

std::string WrongTokens::source_of(const ip::address& address) {
  if (address.is_v4()) return address.to_string();
  const ip::address_v6 six = address.to_v6();
  if (six.is_v4_mapped()) return ip::make_address_v4(ip::v4_mapped, six).to_string();
  ip::address_v6::bytes_type bytes = six.to_bytes();
  std::fill(bytes.begin() + 8, bytes.end(), 0);
  return ip::address_v6(bytes).to_string() + "/64";
}

WrongTokens::Delay WrongTokens::pause(int wrong) const {
  return std::min<Delay>(longest_, kFirstDelay * (1 << std::min(wrong - 1, kMaxDoublings)));
}

WrongTokens::Verdict WrongTokens::count(const std::string& source, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (!rows_.contains(source)) make_room();
  Row& row = rows_[source];
  row.wrong = now - row.latest > kMemory ? 1 : row.wrong + 1;
  row.latest = now;
  return {row.wrong, pause(row.wrong)};
}

void WrongTokens::forgive(const std::string& source) {
  const std::lock_guard lock(mutex_);
  rows_.erase(source);
}

void WrongTokens::make_room() {
  if (rows_.size() < kMaxSources) return;
  const auto earlier = [](const auto& a, const auto& b) { return a.second.latest < b.second.latest; };
  rows_.erase(std::ranges::min_element(rows_, earlier));
}

TokenAttempts::Update TokenAttempts::update(int wrong) {
  Update all{wrong - wrong_};
  for (; wrong_ < wrong; ++wrong_) {
    const auto [in_a_row, delay] = all_->count(source_);
    all.in_a_row = in_a_row;
    all.delay += delay;
  }
  return all;
}

}  // namespace racebeam
