// hello, help, stats, quit
#include <utility>

#include "environment/settings/play_settings.hpp"
#include "protocol/line/commands/help.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "system/named_rows.hpp"

namespace racebeam {
namespace {

// A client that guesses has few guesses for each connection.
void take_token(Context& context, std::string_view word) {
  constexpr int kGuesses = 3;
  const std::string_view token = value_of(word, "token", "hello");
  if (context.peer.admitted) return;
  if (context.service.admission(token)) return void(context.peer.admitted = true);
  context.peer.quitting = ++context.peer.wrong_tokens >= kGuesses;
  throw RequestError(ErrorCode::kUnauthorized, "the token is not one of this server's tokens");
}

}  // namespace

void run_hello(Context& context, Words arguments, Reply& reply) {
  if (!arguments.empty()) take_token(context, arguments[0]);
  const LineLimits& limits = context.service.limits;
  reply.add("server", "racebeam/" + context.service.version);
  reply.add("protocol", 1);
  reply.add("max_line", static_cast<std::int64_t>(limits.line));
  reply.add("max_machines", limits.machines);
  reply.add("max_states", limits.states);
  reply.add("max_request_frames", limits.request_frames);
  reply.add("max_reply", static_cast<std::int64_t>(limits.reply));
  reply.add("max_idle", limits.idle_seconds);
  reply.add("threads", static_cast<std::int64_t>(context.service.threads));
  reply.add("recording", context.service.recorder ? 1 : 0);
  reply.add("admitted", context.peer.admitted ? 1 : 0);
  reply.add_list("encodings", names_of(encodings()));
  reply.add_list("presets", names_of(preset_rows()));
}

void run_help(Context& context, Words arguments, Reply& reply) {
  append_help(reply.add_help(), arguments.empty() ? help() : help_on(arguments[0]), context.peer.columns);
}

void run_stats(Context& context, Words, Reply& reply) {
  const Statistics& all = context.statistics;
  reply.add("requests", all.requests);
  reply.add("errors", all.errors);
  reply.add("acts", all.acts);
  reply.add("frames", all.frames);
  reply.add("episodes", all.episodes);
  reply.add("bytes_in", all.bytes_in);
  reply.add("bytes_out", all.bytes_out);
  reply.add("states", static_cast<std::int64_t>(context.game.states.size()));
  reply.add("machines", static_cast<std::int64_t>(context.machines.size()));
}

void run_quit(Context& context, Words, Reply&) { context.peer.quitting = true; }

}  // namespace racebeam
