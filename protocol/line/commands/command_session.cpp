// hello, help, stats, quit
#include <utility>

#include "protocol/line/commands/help.hpp"
#include "protocol/line/play_settings.hpp"
#include "protocol/line/session.hpp"

namespace racebeam {
namespace {

template <typename Rows>
void append_names(std::string& out, const Rows& rows, char between) {
  bool first = true;
  for (const auto& row : rows) {
    if (!std::exchange(first, false)) out += between;
    out += row.name;
  }
}

// A client that guesses has few guesses for each connection.
void take_token(Session& session, std::string_view word) {
  constexpr int kGuesses = 3;
  const std::string_view token = value_of(word, "token", "hello");
  if (session.admitted) return;
  if (session.service.admission(token)) return session.admit();
  session.quitting = ++session.wrong_tokens >= kGuesses;
  throw RequestError(ErrorCode::kUnauthorized, "that token is not one of this server's");
}

}  // namespace

void run_hello(Session& session, Words arguments) {
  if (!arguments.empty()) take_token(session, arguments[0]);
  const LineLimits& limits = session.service.limits;
  std::string& out = session.out;
  ((out += "ok server=racebeam/") += session.service.version) += " protocol=1";
  append_pair(out, "max_line", static_cast<std::int64_t>(limits.line));
  append_pair(out, "max_machines", limits.machines);
  append_pair(out, "max_states", limits.states);
  append_pair(out, "max_request_frames", limits.request_frames);
  append_pair(out, "max_reply", static_cast<std::int64_t>(limits.reply));
  append_pair(out, "max_idle", limits.idle_seconds);
  append_pair(out, "threads", static_cast<std::int64_t>(session.service.threads));
  append_pair(out, "recording", session.service.recorder ? 1 : 0);
  append_pair(out, "admitted", session.admitted ? 1 : 0);
  append_pair(out, "encodings", "");
  append_names(out, encodings(), ',');
  append_pair(out, "presets", "");
  append_names(out, preset_rows(), ',');
}

void run_help(Session& session, Words arguments) {
  append_help(session.out, arguments.empty() ? help() : help_on(arguments[0]), session.columns);
}

void run_stats(Session& session, Words) {
  const Statistics& all = session.statistics;
  std::string& out = session.out;
  out += "ok";
  append_pair(out, "requests", all.requests);
  append_pair(out, "errors", all.errors);
  append_pair(out, "acts", all.acts);
  append_pair(out, "frames", all.frames);
  append_pair(out, "episodes", all.episodes);
  append_pair(out, "bytes_in", all.bytes_in);
  append_pair(out, "bytes_out", all.bytes_out);
  append_pair(out, "states", static_cast<std::int64_t>(session.states.size()));
  append_pair(out, "machines", static_cast<std::int64_t>(session.machines.size()));
}

void run_quit(Session& session, Words) {
  session.out += "ok";
  session.quitting = true;
}

}  // namespace racebeam
