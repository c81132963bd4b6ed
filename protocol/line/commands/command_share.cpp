// share, unshare, shared, watch
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "games/game/actions.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "protocol/line/watching.hpp"
#include "system/similar.hpp"

namespace racebeam {
namespace {

constexpr int kMaxWatchers = 1'000'000;
constexpr std::size_t kMaxWatched = 256;  // shared sessions that one session watches

std::string share_name(std::string_view text) {
  constexpr std::size_t kLongest = 64;
  const auto is_sign = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '.' ||
           c == '_' || c == '-';
  };
  if (text.empty() || text.size() > kLongest || !std::ranges::all_of(text, is_sign)) {
    throw RequestError(ErrorCode::kBadValue,
                       "the name " + quote(text) + " must have 1 to 64 letters, digits, '.', '-' and '_'");
  }
  return std::string(text);
}

constexpr std::size_t kMaxSimilar = 256;  // names that are compared: more would take milliseconds

[[noreturn]] void refuse_unknown(const Context& context, std::string_view name) {
  const auto all = context.service.shares->all();
  std::vector<std::string_view> names;
  for (const auto& share : std::span(all).first(std::min(all.size(), kMaxSimilar)))
    names.push_back(share->name());
  throw RequestError(ErrorCode::kBadValue, "unknown shared session " + quote(name) + ";" +
                                               did_you_mean(name, names) + " shared lists them");
}

std::unique_ptr<Share::Place> place_of(const std::shared_ptr<Share>& share) {
  if (auto place = Share::place(share)) return place;
  throw RequestError(ErrorCode::kLimit, share->name() + " has " + std::to_string(share->most_watchers()) +
                                            " watchers, the most that it allows");
}

// Makes room for one more name. Names that are no longer shared are forgotten first.
void make_room(Watching& watching) {
  if (watching.size() < kMaxWatched) return;
  std::erase_if(watching, [](const auto& entry) { return entry.second.ended(); });
  if (watching.size() < kMaxWatched) return;
  throw RequestError(ErrorCode::kLimit,
                     "a session may watch " + std::to_string(kMaxWatched) + " shared sessions");
}

// A name that is shared anew keeps what its last reply showed, since the watcher keeps it, too.
Watched& watched(Context& context, std::string_view name) {
  for (auto& [share_name, subject] : context.watching)
    if (subject.ended()) subject.leave();
  const auto found = context.watching.find(name);
  const bool is_known = found != context.watching.end();
  if (is_known && !found->second.ended()) return found->second;
  const auto share = context.service.shares->find(name);
  if (!share) refuse_unknown(context, name);
  if (!is_known) make_room(context.watching);
  auto place = place_of(share);
  Watched& subject = is_known ? found->second : context.watching[std::string(name)];
  subject.enter(std::move(place));
  return subject;
}

void add_scores(Reply& reply, const Snapshot& snapshot) {
  reply.add("game", snapshot.game);
  reply.add("frame", snapshot.frame);
  reply.add("score", snapshot.score);
  reply.add("episode", snapshot.episode);
}

// Returns 0 if the session has not published for a while, because it waits for its client.
std::int64_t frames_a_second(const Snapshot& snapshot) {
  constexpr std::chrono::seconds kPause{2};
  const bool pauses = Snapshot::Clock::now() - snapshot.when > kPause;
  return pauses ? 0 : std::llround(snapshot.fps);
}

}  // namespace

void run_share(Context& context, Words arguments, Reply& reply) {
  const std::string name = share_name(arguments[0]);
  int most = kUsualWatchers;
  if (arguments.size() > 1) {
    most = static_cast<int>(
        number_within(value_of(arguments[1], "watchers", "share"), "watchers", 1, kMaxWatchers));
  }
  auto sharing = Sharing::open(context.service.shares, name, most, context.sharing.get());
  if (!sharing)
    throw RequestError(ErrorCode::kBadValue,
                       "another session is shared as " + quote(name) + "; choose another name");
  context.sharing = std::move(sharing);
  reply.add("share", name);
  reply.add("watchers", most);
}

void run_unshare(Context& context, Words, Reply&) {
  if (context.service.share_all)
    throw RequestError(ErrorCode::kBadValue,
                       "unshare is not possible: this server shares all sessions (--watch all)");
  context.sharing.reset();
}

void run_shared(Context& context, Words, Reply& reply) {
  std::vector<std::pair<std::string, std::shared_ptr<const Snapshot>>> snapshots;
  for (const auto& share : context.service.shares->all()) {
    // A session that has just been shared may not have one yet.
    if (auto snapshot = share->newest()) snapshots.emplace_back(share->name(), std::move(snapshot));
  }
  reply.add("count", static_cast<std::int64_t>(snapshots.size()));
  for (const auto& [name, snapshot] : snapshots) {
    reply.add_group();
    reply.add("name", name);
    add_scores(reply, *snapshot);
    reply.add("fps", frames_a_second(*snapshot));
  }
}

void run_watch(Context& context, Words arguments, Reply& reply) {
  Words words = arguments.subspan(1);
  std::optional<std::int64_t> since;
  if (!words.empty() && words[0].starts_with("since=")) {
    constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
    since = number_within(value_of(words[0], "since", "watch"), "since", -kMax, kMax);
    words = words.subspan(1);
  }
  const std::vector<Field> fields = parse_watched_fields(words);
  context.memory.check(View::max_footprint(fields), "a view of these fields");
  Watched& subject = watched(context, arguments[0]);
  const auto snapshot = subject.newest();
  if (!snapshot) refuse_unknown(context, arguments[0]);
  add_scores(reply, *snapshot);
  reply.add("over", snapshot->over);
  reply.add("lives", snapshot->lives);
  reply.add("reward", snapshot->reward);
  reply.add("action", action_name(snapshot->action));
  reply.add("height", snapshot->height());
  if (since == snapshot->frame) return;
  reply.add_fields([&](std::string& out, std::string& raw) { subject.append(out, raw, fields, *snapshot); });
}

}  // namespace racebeam
