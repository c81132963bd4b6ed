// Counters for the metrics of a server. Sessions that share a thread share a meter.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace racebeam {

// One thread adds, and any thread reads: an addition without a lock.
class Counter {
 public:
  void add(std::int64_t amount) {
    value_.store(value_.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
  }
  std::int64_t value() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> value_ = 0;
};

// Upper bounds of a request's duration, in seconds; one more bucket is for longer ones.
constexpr std::array kLatencyBounds = {0.00001, 0.000025, 0.00005, 0.0001, 0.00025, 0.0005, 0.001, 0.0025,
                                       0.005,   0.01,     0.025,   0.05,   0.1,     0.25,   1.0,   10.0};

class Meter {
 public:
  explicit Meter(std::size_t commands);  // their number

  // Counts one request, from its line to its reply. command: its row in the table of commands, or the number
  // of rows if it is unknown.
  void request(std::size_t command, bool refused, std::chrono::nanoseconds took);

  struct Requests {
    Counter done, refused;
  };
  std::vector<Requests> requests;                              // by command
  std::array<Counter, kLatencyBounds.size() + 1> latencies{};  // each request is in one of them
  Counter nanoseconds;                                         // of all requests
  Counter frames, bytes_in, bytes_out;
};

}  // namespace racebeam
