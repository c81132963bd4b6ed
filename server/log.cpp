#include "server/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <nlohmann/json.hpp>

namespace racebeam {
namespace {

constexpr std::array kLevels = {spdlog::level::debug, spdlog::level::info, spdlog::level::warn,
                                spdlog::level::err, spdlog::level::off};
constexpr std::array kNames = {"debug", "info", "warning", "error", "off"};

std::atomic<LogFormat> format = LogFormat::kText;

spdlog::logger& logger() {
  static const auto made = [] {
    auto standard_error = spdlog::stderr_logger_mt("racebeam");
    standard_error->set_pattern("racebeam: %v");
    standard_error->flush_on(spdlog::level::trace);
    return standard_error;
  }();
  return *made;
}

// What a client sent may be in it.
std::string printable(std::string_view text) {
  std::string clean(text);
  std::ranges::replace_if(
      clean, [](char c) { return c < ' ' || c > '~'; }, '?');
  return clean;
}

std::string as_json(LogLevel level, const std::string& sentence, std::initializer_list<LogField> fields) {
  nlohmann::ordered_json line;
  line["level"] = kNames[static_cast<std::size_t>(level)];
  line["message"] = printable(sentence);
  for (const LogField& field : fields) line[std::string(field.key)] = printable(field.value);
  return line.dump().substr(1);  // the time comes before it, from the pattern
}

}  // namespace

void set_up_log(LogLevel least, LogFormat wanted) {
  format = wanted;
  logger().set_level(kLevels[static_cast<std::size_t>(least)]);
  if (wanted == LogFormat::kText) return;
  auto in_utc = std::make_unique<spdlog::pattern_formatter>(R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ",%v)",
                                                            spdlog::pattern_time_type::utc);
  logger().set_formatter(std::move(in_utc));
}

void log(LogLevel level, const std::string& sentence, std::initializer_list<LogField> fields) {
  const auto importance = kLevels[static_cast<std::size_t>(level)];
  if (!logger().should_log(importance)) return;
  if (format == LogFormat::kJson) return logger().log(importance, "{}", as_json(level, sentence, fields));
  const char* mark = level == LogLevel::kWarning ? "warning: " : level == LogLevel::kError ? "error: " : "";
  logger().log(importance, "{}{}", mark, printable(sentence));
}

}  // namespace racebeam
