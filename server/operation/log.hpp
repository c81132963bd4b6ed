// What the server says to the person who started it: one line an event, on standard error.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace racebeam {

enum class LogLevel { kDebug, kInfo, kWarning, kError, kOff };
enum class LogFormat {
  kText,  // racebeam: SENTENCE; a warning: racebeam: warning: SENTENCE
  kJson   // {"time":"2026-01-31T12:00:00.123Z","level":"info","message":"SENTENCE",...}
};

// Before there are threads. Without it: text, from information upwards.
void set_up_log(LogLevel least, LogFormat format);

// What a program that reads the log wants to find without understanding the sentence; shown in JSON.
struct LogField {
  std::string_view key, value;
};

// From any thread; lines never mix. Bytes that are no printable ASCII become '?', and what is very long is
// cut. Never waits: see log_sink.hpp.
void log(LogLevel level, const std::string& sentence, std::initializer_list<LogField> fields = {});

void write_log();  // lines for which there was no room, if there is now
std::int64_t log_lines_lost();

inline void log(const std::string& sentence, std::initializer_list<LogField> fields = {}) {
  log(LogLevel::kInfo, sentence, fields);
}
inline void log_warning(const std::string& sentence, std::initializer_list<LogField> fields = {}) {
  log(LogLevel::kWarning, sentence, fields);
}

}  // namespace racebeam
