#include "server/operation/metrics.hpp"

#include <charconv>

#include "protocol/line/commands/command_table.hpp"
#include "server/operation/log.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

constexpr double kNanosecond = 1e-9;

void append_head(std::string& out, const std::string& name, const std::string& type,
                 const std::string& help) {
  out += "# HELP racebeam_" + name + " " + help + "\n# TYPE racebeam_" + name + " " + type + "\n";
}

template <typename Number>
std::string number_text(Number number) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

template <typename Number>
void append_value(std::string& out, const std::string& name, Number value) {
  out += "racebeam_" + name + " " + number_text(value) + "\n";
}

std::string name_of_row(std::size_t row) {
  return row < commands().size() ? std::string(commands()[row].name) : "none";
}

}  // namespace

Meter& Metrics::add_meter() { return meters_.emplace_back(commands().size()); }

template <typename Part>
std::int64_t Metrics::sum(Part part) const {
  std::int64_t all = 0;
  for (const Meter& meter : meters_) all += part(meter).value();
  return all;
}

void Metrics::append_memory(std::string& out) const {
  append_head(out, "memory_bytes", "gauge",
              "Memory: what the system has given, what is counted, and the most that may be counted.");
  append_value(out, "memory_bytes{kind=\"resident\"}", resident_memory());
  if (memory == nullptr) return;
  append_value(out, "memory_bytes{kind=\"counted\"}", memory->taken());
  append_value(out, "memory_bytes{kind=\"limit\"}", memory->most());
}

void Metrics::append_requests(std::string& out) const {
  append_head(out, "requests_total", "counter", "Requests of the line protocol, by command and outcome.");
  for (std::size_t row = 0; row <= commands().size(); ++row) {
    const std::string command = "requests_total{command=\"" + name_of_row(row) + "\",outcome=\"";
    append_value(out, command + "ok\"}",
                 sum([row](const Meter& m) -> auto& { return m.requests[row].done; }));
    append_value(out, command + "error\"}",
                 sum([row](const Meter& m) -> auto& { return m.requests[row].refused; }));
  }
}

void Metrics::append_latencies(std::string& out) const {
  append_head(out, "request_seconds", "histogram",
              "Time from the end of a request's line to the end of its reply.");
  std::int64_t below = 0;
  for (std::size_t i = 0; i <= kLatencyBounds.size(); ++i) {
    below += sum([i](const Meter& meter) -> auto& { return meter.latencies[i]; });
    const std::string bound = i < kLatencyBounds.size() ? number_text(kLatencyBounds[i]) : "+Inf";
    append_value(out, "request_seconds_bucket{le=\"" + bound + "\"}", below);
  }
  const auto nanoseconds = sum([](const Meter& meter) -> auto& { return meter.nanoseconds; });
  append_value(out, "request_seconds_sum", static_cast<double>(nanoseconds) * kNanosecond);
  append_value(out, "request_seconds_count", below);
}

std::string Metrics::text() const {
  std::string out;
  append_head(out, "sessions_open", "gauge", "Sessions that are open.");
  append_value(out, "sessions_open", sessions_open.load());
  append_head(out, "sessions_total", "counter", "Sessions that began, by protocol.");
  append_value(out, "sessions_total{protocol=\"line\"}", sessions_line.load());
  append_value(out, "sessions_total{protocol=\"classic\"}", sessions_classic.load());
  append_head(out, "sessions_refused_total", "counter", "Connections that got no session, by reason.");
  append_value(out, "sessions_refused_total{reason=\"busy\"}", refused_busy.load());
  append_value(out, "sessions_refused_total{reason=\"tls\"}", refused_tls.load());
  append_head(out, "sessions_ended_total", "counter", "Sessions that the server ended, by reason.");
  append_value(out, "sessions_ended_total{reason=\"idle\"}", ended_idle.load());
  append_value(out, "sessions_ended_total{reason=\"handshake\"}", ended_handshake.load());
  append_value(out, "sessions_ended_total{reason=\"stopping\"}", ended_stopping.load());
  append_value(out, "sessions_ended_total{reason=\"busy\"}", ended_busy.load());
  append_head(out, "wrong_tokens_total", "counter", "Wrong tokens from clients.");
  append_value(out, "wrong_tokens_total", wrong_tokens.load());
  append_head(out, "frames_total", "counter", "Frames that machines have run for requests.");
  append_value(out, "frames_total", sum([](const Meter& meter) -> auto& { return meter.frames; }));
  append_head(out, "received_bytes_total", "counter", "Bytes from clients, without TLS.");
  append_value(out, "received_bytes_total", sum([](const Meter& meter) -> auto& { return meter.bytes_in; }));
  append_head(out, "sent_bytes_total", "counter", "Bytes to clients, without TLS.");
  append_value(out, "sent_bytes_total", sum([](const Meter& meter) -> auto& { return meter.bytes_out; }));
  append_head(out, "log_lines_lost_total", "counter",
              "Lines of the log that were dropped because its reader is slow.");
  append_value(out, "log_lines_lost_total", log_lines_lost());
  append_memory(out);
  append_requests(out);
  append_latencies(out);
  return out;
}

}  // namespace racebeam
