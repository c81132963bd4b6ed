#include "server/operation/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <new>
#include <nlohmann/json.hpp>

#include "server/operation/log_sink.hpp"

namespace racebeam {
namespace {

constexpr std::array kLevels = {spdlog::level::debug, spdlog::level::info, spdlog::level::warn,
                                spdlog::level::err, spdlog::level::off};
constexpr std::array kNames = {"debug", "info", "warning", "error", "off"};

std::atomic<LogFormat> format = LogFormat::kText;
std::atomic<std::int64_t> without_memory = 0;  // lines that were lost because there was no memory for them

// Makes text that may contain a client's bytes safe to log. A line must fit into a page, which a pipe accepts
// as a whole or not at all.
std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  std::string clean(text.substr(0, kLongest));
  std::ranges::replace_if(
      clean, [](char c) { return c < ' ' || c > '~'; }, '?');
  return clean;
}

std::string as_json(LogLevel level, const std::string& sentence, std::initializer_list<LogField> fields) {
  nlohmann::ordered_json line;
  line["level"] = kNames[static_cast<std::size_t>(level)];
  line["message"] = printable(sentence);
  for (const LogField& field : fields) line[std::string(field.key)] = printable(field.value);
  return line.dump().substr(1);  // the pattern writes the time before it
}

// The part of a line after the pattern's output.
std::string payload(LogLevel level, const std::string& sentence, std::initializer_list<LogField> fields) {
  if (format == LogFormat::kJson) return as_json(level, sentence, fields);
  const char* mark = level == LogLevel::kWarning ? "warning: " : level == LogLevel::kError ? "error: " : "";
  return mark + printable(sentence);
}

std::string loss_text(std::int64_t lines) {
  return payload(LogLevel::kWarning,
                 std::to_string(lines) + " lines of the log are lost: its reader is too slow",
                 {{"event", "lost"}});
}

const std::shared_ptr<LogSink>& sink() {
  struct Closing {
    const std::shared_ptr<LogSink> sink;
    ~Closing() { sink->close(); }
  };
  static const Closing closing{LogSink::start(kStandardError, kind_of_output(kStandardError), loss_text)};
  return closing.sink;
}

spdlog::logger& logger() {
  static spdlog::logger logger = [] {
    spdlog::logger standard_error("racebeam", sink());
    standard_error.set_pattern("racebeam: %v");
    standard_error.flush_on(spdlog::level::trace);
    standard_error.set_error_handler([](const std::string&) { ++without_memory; });
    return standard_error;
  }();
  return logger;
}

}  // namespace

void set_up_log(LogLevel least, LogFormat log_format) {
  format = log_format;
  logger().set_level(kLevels[static_cast<std::size_t>(least)]);
  if (log_format == LogFormat::kText) return;
  auto in_utc = std::make_unique<spdlog::pattern_formatter>(R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ",%v)",
                                                            spdlog::pattern_time_type::utc);
  logger().set_formatter(std::move(in_utc));
}

void log(LogLevel level, const std::string& sentence, std::initializer_list<LogField> fields) {
  const auto importance = kLevels[static_cast<std::size_t>(level)];
  if (!logger().should_log(importance)) return;
  try {
    logger().log(importance, "{}", payload(level, sentence, fields));
  } catch (const std::bad_alloc&) {
    ++without_memory;
  }
}

void write_log() { sink()->flush(); }

std::int64_t log_lines_lost() { return sink()->lost() + without_memory; }

}  // namespace racebeam
