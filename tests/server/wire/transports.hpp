// Runs a job's requests over each transport, with racebeam and with an echo server on plain sockets that
// sends the same bytes. The serving process is separate, and is timed.
#pragma once

#include <sys/types.h>

#include <string>

#include "tests/server/wire/bench_job.hpp"
#include "tests/server/wire/line_channel.hpp"

namespace wire {

struct Cost {
  double rate;          // steps a second
  double microseconds;  // of the processor, for a step, in the process that serves
};

// The time of the serving process for some work.
class Meter {
 public:
  explicit Meter(pid_t server);
  Cost of(int steps) const;

 private:
  pid_t server_;
  double busy_, begin_;
};

// racebeam. Records the output if `replies` is not null. All throw std::runtime_error.
Cost over_standard_streams(const Job& job, Lines* replies = nullptr);
Cost over_socket(const Job& job, bool tcp);

// The echo server: answers each line with a line of `replies`.
Cost echo_over_standard_streams(const Job& job, const Lines& replies);
Cost echo_over_socket(const Job& job, const Lines& replies, bool tcp);
void echo(LineChannel channel, const Lines& replies);
Lines read_lines(const std::string& path);

}  // namespace wire
