// The metrics of a server, in the text format of Prometheus.
#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <string>

#include "protocol/line/meter.hpp"
#include "protocol/running/memory_budget.hpp"

namespace racebeam {

// Counts something during its lifetime.
class Counted {
 public:
  explicit Counted(std::atomic<std::int64_t>& count) : count_(count) { ++count_; }
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::atomic<std::int64_t>& count_;
};

class Metrics {
 public:
  Meter& add_meter();  // for a thread that serves; before other threads read

  std::string text() const;  // thread-safe

  std::shared_ptr<const MemoryBudget> memory;  // of all sessions; null: unlimited

  // Counted by any thread:
  std::atomic<std::int64_t> sessions_open = 0, sessions_classic = 0, sessions_line = 0;
  std::atomic<std::int64_t> refused_busy = 0, refused_tls = 0, wrong_tokens = 0;
  std::atomic<std::int64_t> ended_idle = 0, ended_handshake = 0, ended_stopping = 0, ended_busy = 0;
  // Sessions that gave their token or do not need one, for --until-idle: those that are open, and all so far.
  std::atomic<std::int64_t> admitted_open = 0, admitted = 0;

 private:
  template <typename Part>
  std::int64_t sum(Part part) const;
  void append_memory(std::string& out) const;
  void append_requests(std::string& out) const;
  void append_latencies(std::string& out) const;

  std::list<Meter> meters_;
};

}  // namespace racebeam
