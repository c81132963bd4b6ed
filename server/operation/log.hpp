// The server's log for its operator: one line for each event, on standard error.
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

// Call it before threads start. Without it, the format is text and the level info.
void set_up_log(LogLevel least, LogFormat format);

// A value for programs that read the log; only JSON shows it.
struct LogField {
  std::string_view key, value;
};

// Thread-safe; lines never mix. Bytes other than printable ASCII become '?', and long lines are truncated.
// It never blocks (log_sink.hpp), and never throws. Without memory for a line, the line is lost.
void log(LogLevel level, const std::string& sentence, std::initializer_list<LogField> fields = {});

void write_log();  // writes the lines that wait, if there is room now
std::int64_t log_lines_lost();

inline void log(const std::string& sentence, std::initializer_list<LogField> fields = {}) {
  log(LogLevel::kInfo, sentence, fields);
}
inline void log_warning(const std::string& sentence, std::initializer_list<LogField> fields = {}) {
  log(LogLevel::kWarning, sentence, fields);
}

}  // namespace racebeam
