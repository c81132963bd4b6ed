// What has been done, counted for those who watch a server. Sessions that share a thread share a meter.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace racebeam {

// One thread adds, any thread reads: a plain addition, without a lock.
class Counter {
 public:
  void add(std::int64_t amount) {
    value_.store(value_.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
  }
  std::int64_t value() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> value_ = 0;
};

// Upper bounds, in seconds, of how long a request took; beyond the last there is one more group.
constexpr std::array kLatencyBounds = {0.00001, 0.000025, 0.00005, 0.0001, 0.00025, 0.0005, 0.001, 0.0025,
                                       0.005,   0.01,     0.025,   0.05,   0.1,     0.25,   1.0,   10.0};

class Meter {
 public:
  explicit Meter(std::size_t commands);  // that there are

  // One request, from its line to its reply. `command`: its row in the table of commands, or their number for what is
  // none.
  void request(std::size_t command, bool refused, std::chrono::nanoseconds took);

  struct Requests {
    Counter done, refused;
  };
  std::vector<Requests> requests;                              // by command
  std::array<Counter, kLatencyBounds.size() + 1> latencies{};  // each request in one of them
  Counter nanoseconds;                                         // of all requests
  Counter frames, bytes_in, bytes_out;
};

}  // namespace racebeam
