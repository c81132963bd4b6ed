#include "protocol/line/session.hpp"

#include <algorithm>
#include <utility>

#include "protocol/line/command.hpp"
#include "protocol/tuning.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kShortLine = 4096;
// Memory that a word of a request may take, as an action and as its reward.
constexpr std::size_t kBytesOfWord = 48;

// Returns how many bytes a line may have. A client without a token needs only short lines.
std::size_t longest_line(const LineService& service, bool admitted) {
  constexpr std::size_t kLongestBefore = 4096;
  return admitted ? service.limits.line : std::min(kLongestBefore, service.limits.line);
}

std::size_t first_unprintable(std::string_view line) {
  const auto bad = std::ranges::find_if(line, [](char c) { return c < ' ' || c > '~'; });
  return static_cast<std::size_t>(bad - line.begin());
}

std::size_t count_words(std::string_view line) {
  std::size_t words = 0;
  char before = ' ';
  for (const char c : line) words += std::exchange(before, c) == ' ' && c != ' ';
  return words;
}

void check_bytes(std::string_view line) {
  const std::size_t bad = first_unprintable(line);
  if (bad == line.size()) return;
  const auto byte = static_cast<unsigned char>(line[bad]);
  throw RequestError(ErrorCode::kBadLine, "byte " + std::to_string(bad + 1) + " of the line has the value " +
                                              std::to_string(byte) +
                                              "; a request is printable ASCII, 32 to 126");
}

}  // namespace

Session::Session(const LineService& service, const CommandTable& table, Meter* counting,
                 const std::shared_ptr<MemoryBudget>& budget)
    : context_(service, budget),
      input_(longest_line(service, context_.peer.admitted)),
      table_(table),
      meter_(counting) {
  context_.memory.set(footprint());
}

Session::~Session() {
  leave();
  release_pages(reply_.text_memory());
  release_pages(reply_.raw_memory());
}

bool Session::run(std::chrono::microseconds slice) {
  const auto begin = looked_ = Clock::now(), end = begin + slice;
  if (!context_.pacer.in_progress()) began_ = begin;
  bool more = true;
  for (bool late = false; more && !late && !done_ && !pauses() && !waits(); late = looked_ >= end)
    more = resume(end);
  worked_ = looked_ - begin;
  return more && !done_;
}

// Whether enough output waits to be sent. A client that reads slowly thus delays only its own requests.
bool Session::has_enough() const {
  return context_.pacer.frames() - sent_frames_ >= tuning::kFramesOfReplies ||
         reply_.text().size() >= std::min(tuning::kBytesOfReplies, context_.service.limits.output);
}

// Whether replies are sent before the next request. The server delays tokens one by one.
bool Session::pauses() const {
  if (context_.pacer.in_progress() || reply_.text().empty() || input_.empty()) return false;
  return !context_.peer.admitted || has_enough() ||
         (context_.statistics.requests - sent_requests_ >= tuning::kFewReplies &&
          input_.lines(tuning::kLastRequests + 1) == tuning::kLastRequests);
}

bool Session::waits() const { return context_.pacer.in_progress() && context_.waits_for_disk(); }

// Works on a request until `end`. Returns false if it can only wait for more input.
bool Session::resume(Clock::time_point end) {
  if (context_.pacer.in_progress()) {
    guarded([&] { context_.pacer.resume(end); });
  } else {
    const auto line = next_line();
    if (!line) {
      done_ = input_.ended();
      return false;
    }
    if (ignores(*line)) return true;
    begin_request();
    guarded([&] { context_.pacer.work(end, [this, line = *line] { guarded([&] { take(line); }); }); });
  }
  looked_ = Clock::now();
  if (!context_.pacer.in_progress()) finish_reply();
  return true;
}

void Session::refuse(ErrorCode code, std::string_view sentence) {
  reply_.refuse(code, sentence);
  ++context_.statistics.errors;
  refused_ = true;
}

template <typename Step>
void Session::guarded(Step step) {
  try {
    step();
  } catch (const RequestError& error) {
    refuse(error.code(), error.what());
  } catch (const InvalidArguments& error) {
    refuse(ErrorCode::kBadArguments, error.what());
  } catch (const InvalidInput& error) {
    refuse(ErrorCode::kBadValue, error.what());
  } catch (const std::bad_alloc&) {
    refuse(ErrorCode::kLimit, "the system has no more memory for this request");
  } catch (const std::exception& error) {
    refuse_fault(error.what());
  }
}

// Reports an internal error of the server, and logs it.
void Session::refuse_fault(const std::string& what) {
  refuse(ErrorCode::kInternal, what);
  const std::string name(command_ < table_.commands.size() ? table_.commands[command_].name : "a request");
  if (context_.service.report_fault) context_.service.report_fault("internal error in " + name + ": " + what);
}

void Session::begin_request() {
  ++context_.statistics.requests;
  reply_.begin();
  context_.pacer.allow_any_frames();
  command_ = table_.commands.size();
  refused_ = false;
}

// A line that memory does not suffice for is cut, so that it gets a reply, and its rest is skipped.
std::optional<LineReader::Line> Session::next_line() {
  const auto line = input_.next();
  const std::size_t growth = line || input_.ended() ? 0 : input_.growth();
  if (growth == 0) return line;
  try {
    if (context_.memory.grow(growth)) return input_.grow(), std::nullopt;
  } catch (const std::bad_alloc&) {
    context_.memory.set(footprint());
  }
  input_.cut_line();
  return input_.next();
}

// Whether the line is a comment, which gets no reply.
bool Session::ignores(const LineReader::Line& line) {
  const std::size_t first = line.text.find_first_not_of(' ');
  if (first == std::string_view::npos || line.text[first] != '#') return false;
  context_.statistics.bytes_in += static_cast<std::int64_t>(line.text.size() + 1);
  began_ = looked_ = Clock::now();  // when the next request begins
  return true;
}

void Session::take(const LineReader::Line& line) {
  context_.statistics.bytes_in += static_cast<std::int64_t>(line.text.size() + 1);
  if (line.kind == LineReader::Kind::kLine) return execute(line.text);
  if (line.kind == LineReader::Kind::kHalf)
    throw RequestError(ErrorCode::kHalfLine, "the input ended within a line; the server did not execute it");
  if (line.kind == LineReader::Kind::kCut) {
    throw RequestError(ErrorCode::kLimit, "the server has no memory for a line of more than " +
                                              std::to_string(input_.capacity()) + " bytes; it was skipped");
  }
  throw RequestError(ErrorCode::kLineTooLong,
                     "the line has more than " + std::to_string(input_.longest()) + " bytes; it was skipped");
}

void Session::execute(std::string_view line) {
  if (line.size() > kShortLine)
    context_.memory.check(kBytesOfWord * count_words(line), "a line of so many words");
  check_bytes(line);
  read_words(line);
  if (words_.empty()) throw RequestError(ErrorCode::kBadLine, "the line is empty; help lists the commands");
  if (context_.statistics.requests == 1) refuse_http();
  if (!context_.peer.admitted && !table_.look_up(words_[0])) refuse_without_token(words_[0]);
  const Command& command = table_.find(words_[0]);
  command_ = table_.row(command);
  const Words arguments = Words(words_).subspan(1);
  check(command, context_, arguments.size());
  renew_words(command);
  reply_.answer(command);
  command.run(context_, arguments, reply_);
}

// Splits the line into words_. There may be half a million.
void Session::read_words(std::string_view line) {
  constexpr std::size_t kWordsBetweenLooks = 1024;
  words_.clear();
  for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
    words_.push_back(word);
    if (words_.size() % kWordsBetweenLooks == 0) context_.pacer.yield_if_due();
  }
}

// Ends a session that begins with a request of HTTP. A page in a browser can make the browser send one, from
// any site, and the lines that would follow are the page's.
void Session::refuse_http() {
  if (words_.size() != 3 || !words_[2].starts_with("HTTP/")) return;
  context_.peer.quitting = true;
  throw RequestError(ErrorCode::kUnknownCommand,
                     "this address takes the line protocol, not HTTP; the server closes the session");
}

// Replaces the old words of a request. Fields stay as they are, since the reply has their names.
void Session::renew_words(const Command& command) {
  if (!command.has_old) return;
  for (std::string_view& word : std::span(words_).subspan(1)) {
    context_.pacer.yield_if_due();
    const OldWord* const row = command.takes_fields ? old_field(word) : old_word(command.name, word);
    if (row == nullptr) continue;
    report_old(*row);
    if (row->is_same && !command.takes_fields) word = keep_word(new_word(*row, word));
  }
}

// Until the end of the request.
std::string_view Session::keep_word(std::string word) {
  context_.memory.check(sizeof word + word.capacity(), "a line of so many old words");
  return new_words_.emplace_back(std::move(word));
}

void Session::report_old(const OldWord& row) {
  if (context_.service.old_words->add(row) && context_.service.report_old_word)
    context_.service.report_old_word("a client uses an old word: " + deprecation_of(row));
}

void Session::finish_reply() {
  context_.statistics.bytes_out += static_cast<std::int64_t>(reply_.finish());
  done_ = context_.peer.quitting || refused();
  if (!new_words_.empty()) new_words_.clear();
  input_.set_longest(longest_line(context_.service, context_.peer.admitted));
  context_.memory.set(footprint());
  // The client has its reply already, or gets it at the same time as without watchers.
  if (context_.sharing && context_.sharing->share().is_wanted() && context_.sharing->share().is_due(looked_))
    context_.publish();
  if (meter_) measure();
  began_ = looked_;  // when the next request begins, if it is here
}

void Session::measure() {
  meter_->request(command_, refused_, looked_ - began_);
  meter_->frames.add(context_.statistics.frames - metered_frames_);
  metered_frames_ = context_.statistics.frames;
}

// The bytes of memory that the session holds. A request checks large allocations by itself. A long reply
// counts before it is made.
std::size_t Session::footprint() const {
  constexpr std::size_t kSession = std::size_t{2} << 10;  // the rest, measured
  constexpr std::size_t kLongReply = std::size_t{1} << 18;
  const LoadedGame& game = context_.game;
  std::size_t reply = game.loaded ? View::longest_text(context_.fields) : 0;
  if (reply < kLongReply) reply = 0;
  std::size_t bytes = kSession + std::max(reply, reply_.capacity()) + input_.capacity() +
                      context_.footprint() + words_.capacity() * sizeof(std::string_view);
  if (game.loaded) bytes += game.loaded->footprint(reply > 0 ? View::max_footprint(context_.fields) : 0);
  return bytes;
}

std::string_view Session::whole_replies() const {
  const std::string_view all = reply_.text();
  return context_.pacer.in_progress() ? all.substr(0, reply_.begin_of_last()) : all;
}

void Session::sent(std::size_t count) {
  reply_.sent(count);
  if (reply_.text().empty() && context_.memory.is_short()) release();
  sent_frames_ = context_.pacer.frames();
  sent_requests_ = context_.statistics.requests;
}

void Session::cancel() {
  if (context_.pacer.in_progress()) {
    context_.pacer.cancel();
    reply_.drop();
  }
  done_ = true;
}

void Session::release_caches() {
  if (context_.pacer.in_progress()) return;
  // Watchers see where a session has paused.
  if (context_.game.loaded && context_.sharing) context_.publish();
  release();
}

// Releases what the next request can make again.
void Session::release() {
  // A request may wait until its client reads. Its words are in use.
  if (context_.pacer.in_progress()) return;
  context_.release_caches();
  if (reply_.text().empty()) context_.discard(reply_.text_memory());
  context_.discard(reply_.raw_memory());
  std::vector<std::string_view>().swap(words_);
  context_.memory.set(footprint());
}

}  // namespace racebeam
