#include "server/operation/metrics.hpp"

#include <catch2/catch.hpp>
#include <chrono>

#include "protocol/line/commands/command_table.hpp"

using namespace racebeam;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

// The value of a line of the metrics.
std::string value(const std::string& text, const std::string& name) {
  const std::string begin = "\nracebeam_" + name + " ";
  const std::size_t at = text.find(begin);
  if (at == std::string::npos) return "missing";
  const std::size_t from = at + begin.size();
  return text.substr(from, text.find('\n', from) - from);
}

}  // namespace

TEST_CASE("each number of the metrics has its own line") {
  Metrics metrics;
  Meter& meter = metrics.add_meter();
  metrics.sessions_open = 1, metrics.sessions_line = 2, metrics.sessions_classic = 3;
  metrics.refused_busy = 4, metrics.refused_tls = 5, metrics.wrong_tokens = 6;
  metrics.ended_idle = 7, metrics.ended_handshake = 8, metrics.ended_stopping = 9, metrics.ended_busy = 10;
  meter.frames.add(11), meter.bytes_in.add(12), meter.bytes_out.add(13);
  const std::pair<const char*, const char*> rows[] = {
      {"sessions_open", "1"},
      {"sessions_total{protocol=\"line\"}", "2"},
      {"sessions_total{protocol=\"classic\"}", "3"},
      {"sessions_refused_total{reason=\"busy\"}", "4"},
      {"sessions_refused_total{reason=\"tls\"}", "5"},
      {"wrong_tokens_total", "6"},
      {"sessions_ended_total{reason=\"idle\"}", "7"},
      {"sessions_ended_total{reason=\"handshake\"}", "8"},
      {"sessions_ended_total{reason=\"stopping\"}", "9"},
      {"sessions_ended_total{reason=\"busy\"}", "10"},
      {"frames_total", "11"},
      {"received_bytes_total", "12"},
      {"sent_bytes_total", "13"},
  };
  const std::string text = metrics.text();
  for (const auto& [name, expected] : rows) {
    INFO(name);
    CHECK(value(text, name) == expected);
  }
}

TEST_CASE("the meters of all threads are summed, by command and outcome") {
  Metrics metrics;
  Meter &one = metrics.add_meter(), &other = metrics.add_meter();
  one.frames.add(1), other.frames.add(2);
  const std::size_t last = commands().size() - 1;
  one.request(0, false, 1ms);
  other.request(0, false, 1ms);
  other.request(0, true, 1ms);
  one.request(last, false, 1ms);
  other.request(commands().size(), true, 1ms);
  const std::string text = metrics.text();
  CHECK(value(text, "frames_total") == "3");
  const auto requests = [&](std::string_view command, const std::string& outcome) {
    return value(text,
                 "requests_total{command=\"" + std::string(command) + "\",outcome=\"" + outcome + "\"}");
  };
  CHECK(requests(commands()[0].name, "ok") == "2");
  CHECK(requests(commands()[0].name, "error") == "1");
  CHECK(requests(commands()[last].name, "ok") == "1");
  CHECK(requests(commands()[last].name, "error") == "0");
  CHECK(requests("none", "error") == "1");
  CHECK(requests("none", "ok") == "0");
}

TEST_CASE("a bucket of the histogram has all requests up to its bound") {
  Metrics metrics;
  Meter& meter = metrics.add_meter();
  for (const auto took : {10us, 11us, 25us, 1000us, 20000000us}) meter.request(0, false, took);
  const std::string text = metrics.text();
  const std::pair<const char*, const char*> rows[] = {{"1e-05", "1"}, {"2.5e-05", "3"}, {"5e-05", "3"},
                                                      {"0.001", "4"}, {"10", "4"},      {"+Inf", "5"}};
  for (const auto& [bound, expected] : rows) {
    INFO(bound);
    CHECK(value(text, "request_seconds_bucket{le=\"" + std::string(bound) + "\"}") == expected);
  }
  CHECK(value(text, "request_seconds_count") == "5");
  CHECK(std::stod(value(text, "request_seconds_sum")) == Approx(20.001046));
}

TEST_CASE("memory that is counted has lines only if it has a limit") {
  Metrics metrics;
  CHECK(value(metrics.text(), "memory_bytes{kind=\"counted\"}") == "missing");
  CHECK(std::stoll(value(metrics.text(), "memory_bytes{kind=\"resident\"}")) > 0);
  const auto budget = std::make_shared<MemoryBudget>(std::uint64_t{1} << 30);
  budget->take_anyway(5000);
  metrics.memory = budget;
  CHECK(value(metrics.text(), "memory_bytes{kind=\"counted\"}") == "5000");
  CHECK(value(metrics.text(), "memory_bytes{kind=\"limit\"}") == "1073741824");
}

TEST_CASE("each metric has a help and a type before its lines") {
  const std::string text = Metrics().text();
  CHECK_THAT(text, Contains("# HELP racebeam_sessions_open Sessions that are open.\n"
                            "# TYPE racebeam_sessions_open gauge\nracebeam_sessions_open 0\n"));
  CHECK_THAT(text, Contains("# TYPE racebeam_request_seconds histogram\n"));
}
