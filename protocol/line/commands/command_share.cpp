// share, unshare, shared, watch
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "games/game/actions.hpp"
#include "games/similar.hpp"
#include "protocol/line/session.hpp"
#include "protocol/line/watching.hpp"

namespace racebeam {
namespace {

constexpr int kMostWatchers = 1'000'000;
constexpr std::size_t kMostWatched = 256;  // shared sessions that one session watches

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

constexpr std::size_t kMostSimilar = 256;  // names that are compared: more would take milliseconds

[[noreturn]] void refuse_unknown(const Session& session, std::string_view name) {
  const auto all = session.service.shares->all();
  std::vector<std::string_view> names;
  for (const auto& share : std::span(all).first(std::min(all.size(), kMostSimilar)))
    names.push_back(share->name());
  throw RequestError(ErrorCode::kBadValue, "there is no shared session " + quote(name) + ";" +
                                               did_you_mean(name, names) + " shared lists them");
}

std::unique_ptr<Share::Place> place_of(const std::shared_ptr<Share>& share) {
  if (auto place = Share::place(share)) return place;
  throw RequestError(ErrorCode::kLimit, share->name() + " has " + std::to_string(share->most_watchers()) +
                                            " watchers, as many as it may have");
}

// Makes room for one more name. Names that are no longer shared are forgotten first.
void make_room(Watching& watching) {
  if (watching.size() < kMostWatched) return;
  std::erase_if(watching, [](const auto& entry) { return entry.second.ended(); });
  if (watching.size() < kMostWatched) return;
  throw RequestError(ErrorCode::kLimit,
                     "a session may watch " + std::to_string(kMostWatched) + " shared sessions");
}

// A name that is shared anew keeps what its last reply showed, since the watcher keeps it, too.
Watched& watched(Session& session, std::string_view name) {
  for (auto& [known, subject] : session.watching)
    if (subject.ended()) subject.leave();
  const auto found = session.watching.find(name);
  const bool is_known = found != session.watching.end();
  if (is_known && !found->second.ended()) return found->second;
  const auto share = session.service.shares->find(name);
  if (!share) refuse_unknown(session, name);
  if (!is_known) make_room(session.watching);
  auto place = place_of(share);
  Watched& subject = is_known ? found->second : session.watching[std::string(name)];
  subject.enter(std::move(place));
  return subject;
}

void append_scores(std::string& out, const Snapshot& snapshot) {
  append_pair(out, "game", snapshot.game);
  append_pair(out, "frame", snapshot.frame);
  append_pair(out, "score", snapshot.score);
  append_pair(out, "episode", snapshot.episode);
}

// 0 if the session has not published for a while: it waits for its client.
std::int64_t frames_a_second(const Snapshot& snapshot) {
  constexpr std::chrono::seconds kPause{2};
  const bool pauses = Snapshot::Clock::now() - snapshot.when > kPause;
  return pauses ? 0 : std::llround(snapshot.fps);
}

}  // namespace

void run_share(Session& session, Words arguments) {
  const std::string name = share_name(arguments[0]);
  int most = kUsualWatchers;
  if (arguments.size() > 1) {
    most = static_cast<int>(
        number_within(value_of(arguments[1], "watchers", "share"), "watchers", 1, kMostWatchers));
  }
  if (session.sharing && session.sharing->share().name() == name) session.sharing.reset();
  auto sharing = Sharing::open(session.service.shares, name, most);
  if (!sharing) throw RequestError(ErrorCode::kBadValue, "the name " + quote(name) + " is taken");
  session.sharing = std::move(sharing);
  session.out += "ok";
  append_pair(session.out, "share", name);
  append_pair(session.out, "watchers", most);
}

void run_unshare(Session& session, Words) {
  if (session.service.share_all)
    throw RequestError(ErrorCode::kBadValue, "this server shares all sessions (--watch all)");
  session.sharing.reset();
  session.out += "ok";
}

void run_shared(Session& session, Words) {
  std::string groups;
  std::int64_t count = 0;
  for (const auto& share : session.service.shares->all()) {
    const auto snapshot = share->newest();
    if (!snapshot) continue;  // in a moment
    ++count;
    groups += " |";
    append_pair(groups, "name", share->name());
    append_scores(groups, *snapshot);
    append_pair(groups, "fps", frames_a_second(*snapshot));
  }
  session.out += "ok";
  append_pair(session.out, "count", count);
  session.out += groups;
}

void run_watch(Session& session, Words arguments) {
  Words words = arguments.subspan(1);
  std::optional<std::int64_t> since;
  if (!words.empty() && words[0].starts_with("since=")) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    since = number_within(value_of(words[0], "since", "watch"), "since", -kMost, kMost);
    words = words.subspan(1);
  }
  const std::vector<Field> fields = parse_watched_fields(words);
  session.memory.check(View::most_held(fields), "a view of these fields");
  Watched& subject = watched(session, arguments[0]);
  const auto snapshot = subject.newest();
  if (!snapshot) refuse_unknown(session, arguments[0]);
  std::string& out = session.out;
  out += "ok";
  append_scores(out, *snapshot);
  append_pair(out, "over", snapshot->over);
  append_pair(out, "lives", snapshot->lives);
  append_pair(out, "reward", snapshot->reward);
  append_pair(out, "action", action_name(snapshot->action));
  append_pair(out, "height", snapshot->height());
  if (since != snapshot->frame) subject.append(out, session.raw, fields, *snapshot);
}

}  // namespace racebeam
