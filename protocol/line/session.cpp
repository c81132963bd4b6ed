#include "protocol/line/session.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "protocol/line/command.hpp"
#include "protocol/line/session_recording.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

// Replies to requests that were sent ahead are sent together. These limit how many wait.
constexpr int kFramesOfReplies = 64;              // take some hundred microseconds
constexpr std::size_t kBytesOfReplies = 1 << 16;  // about twenty screens
// They go out once more when so many requests are left. The client reads them meanwhile, and sends the next.
constexpr std::size_t kLastRequests = 3;
constexpr std::int64_t kFewReplies = 4;  // fewer are not worth waking the client twice

constexpr std::size_t kShortLine = 4096;
// Memory that a word of a request may take, as an action and as its reward.
constexpr std::size_t kBytesOfWord = 48;

const LineLimits& limits(const LineService& service) { return service.limits; }

// Returns how many bytes a line may have. A client without a token needs only short lines.
std::size_t longest_line(const LineService& service, bool admitted) {
  constexpr std::size_t kLongestBefore = 4096;
  return admitted ? limits(service).line : std::min(kLongestBefore, limits(service).line);
}

std::size_t first_unprintable(std::string_view line) {
  const auto bad = std::ranges::find_if(line, [](char c) { return c < ' ' || c > '~'; });
  return static_cast<std::size_t>(bad - line.begin());
}

// A sentence may quote text that the client sent as base64, and that may be any bytes.
void append_printable(std::string& out, std::string_view sentence) {
  for (const char c : sentence) out += c < ' ' || c > '~' ? '?' : c;
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

Session::Session(const LineService& with, const CommandTable& table, Meter* counting,
                 const std::shared_ptr<MemoryBudget>& budget)
    : service(with),
      input(longest_line(with, !with.admission)),
      admitted(!with.admission),
      fields(parse_fields(std::array<std::string_view, 4>{"reward", "terminated", "truncated", "lives"})),
      memory(budget ? budget : with.memory),
      machines(*this),
      table_(table),
      meter_(counting) {
  memory.set(footprint());
}

// The fiber and the recording use the other members, so they go first.
Session::~Session() {
  leave();
  release_pages(out);
  release_pages(raw);
}

void Session::leave() {
  pacer.cancel();
  recording.reset();
  picture.reset();
  sharing.reset();
  watching.clear();
}

void Session::discard(std::string& text) {
  const std::size_t bytes = text.capacity();
  dispose(service.disposal, service.memory, bytes, LongText(std::exchange(text, {})));
}

void Session::check_frames(std::int64_t acts, std::int64_t frames) const {
  const Settings& machine = settings.machine;
  frames += acts * std::max(machine.frame_skip, machine.frame_skip_max);
  const std::int64_t most = limits(service).request_frames;
  if (frames <= most) return;
  throw RequestError(ErrorCode::kLimit, "the request asks for " + std::to_string(frames) +
                                            " frames; it may ask for " + std::to_string(most));
}

void Session::allow_resets(std::size_t count) {
  pacer.allow_frames(limits(service).request_frames + kFreeResetFrames * static_cast<std::int64_t>(count));
}

void Session::check_reply(std::size_t bytes, const std::string& about) const {
  const std::size_t most = limits(service).reply;
  if (bytes <= most) return;
  throw RequestError(ErrorCode::kLimit, "a reply about " + about + " would have about " +
                                            std::to_string(bytes) + " bytes; it may have " +
                                            std::to_string(most));
}

void Session::admit() {
  admitted = true;
  input.set_longest(longest_line(service, admitted));
}

void Session::count(const Outcome& outcome) {
  statistics.acts += outcome.acts;
  statistics.frames += outcome.frames;
  statistics.episodes += outcome.frames > 0 && (outcome.terminated || outcome.truncated);
}

void Session::append_cut() {
  if (recording) recording->append_cut(out);
}

void Session::stop_recording_machines() {
  if (recording && !recording->shows(loaded->slot())) recording.reset();
}

void Session::run_parallel(std::size_t count, const std::function<void(std::size_t)>& task) const {
  if (service.parallel) return service.parallel(count, task);
  for (std::size_t number = 0; number < count; ++number) task(number);
}

bool Session::run(std::chrono::microseconds slice) {
  const auto begin = looked_ = Clock::now(), end = begin + slice;
  if (!pacer.in_progress()) began_ = begin;
  bool more = true;
  for (bool late = false; more && !late && !done_ && !pauses() && !waits(); late = looked_ >= end)
    more = go_on(end);
  worked_ = looked_ - begin;
  return more && !done_;
}

// Whether enough output waits to be sent. A client that reads slowly thus delays only its own requests.
bool Session::has_enough() const {
  return pacer.frames() - sent_frames_ >= kFramesOfReplies ||
         out.size() >= std::min(kBytesOfReplies, limits(service).output);
}

// Whether replies are sent before the next request. The server delays tokens one by one.
bool Session::pauses() const {
  if (pacer.in_progress() || out.empty() || input.empty()) return false;
  return !admitted || has_enough() ||
         (statistics.requests - sent_requests_ >= kFewReplies &&
          input.lines(kLastRequests + 1) == kLastRequests);
}

bool Session::waits() const {
  return pacer.in_progress() && ((recording && recording->is_behind()) || (picture && picture->is_behind()));
}

// Works on a request until `end`. Returns false if there is nothing to do before more input comes.
bool Session::go_on(Clock::time_point end) {
  if (pacer.in_progress()) {
    pacer.go_on(end);
  } else {
    const auto line = next_line();
    if (!line) {
      done_ = input.ended();
      return false;
    }
    if (ignores(*line)) return true;
    begin_request();
    guarded([&] { pacer.work(end, [this, line = *line] { guarded([&] { take(line); }); }); });
  }
  looked_ = Clock::now();
  if (!pacer.in_progress()) finish_reply();
  return true;
}

void Session::drop_reply() {
  out.resize(reply_);
  raw.clear();
}

void Session::refuse(ErrorCode code, std::string_view sentence) {
  drop_reply();
  ((out += "error ") += name_of(code)) += ' ';
  append_printable(out, sentence);
  ++statistics.errors;
  refused_ = true;
}

template <typename Step>
void Session::guarded(Step step) {
  try {
    step();
  } catch (const RequestError& error) {
    refuse(error.code(), error.what());
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
  if (service.report_fault) service.report_fault("internal error in " + name + ": " + what);
}

void Session::begin_request() {
  ++statistics.requests;
  reply_ = out.size();
  pacer.allow_any_frames();
  command_ = table_.commands.size();
  refused_ = false;
}

// A line for which there is no memory is cut, so that it gets a reply, and its rest is skipped.
std::optional<LineReader::Line> Session::next_line() {
  const auto line = input.next();
  const std::size_t growth = line || input.ended() ? 0 : input.growth();
  if (growth == 0) return line;
  try {
    if (memory.grow(growth)) return input.grow(), std::nullopt;
  } catch (const std::bad_alloc&) {
    memory.set(footprint());
  }
  input.cut_line();
  return input.next();
}

// Whether the line is a comment, which gets no reply.
bool Session::ignores(const LineReader::Line& line) {
  const std::size_t first = line.text.find_first_not_of(' ');
  if (first == std::string_view::npos || line.text[first] != '#') return false;
  statistics.bytes_in += static_cast<std::int64_t>(line.text.size() + 1);
  began_ = looked_ = Clock::now();  // when the next request begins
  return true;
}

void Session::take(const LineReader::Line& line) {
  statistics.bytes_in += static_cast<std::int64_t>(line.text.size() + 1);
  if (line.kind == LineReader::Kind::kLine) return execute(line.text);
  if (line.kind == LineReader::Kind::kHalf)
    throw RequestError(ErrorCode::kHalfLine, "the input ended within a line; it was not carried out");
  if (line.kind == LineReader::Kind::kCut) {
    throw RequestError(ErrorCode::kLimit, "the server has no memory for a line of more than " +
                                              std::to_string(input.capacity()) + " bytes; it was skipped");
  }
  throw RequestError(ErrorCode::kLineTooLong,
                     "the line has more than " + std::to_string(input.longest()) + " bytes; it was skipped");
}

void Session::execute(std::string_view line) {
  if (line.size() > kShortLine) memory.check(kBytesOfWord * count_words(line), "a line of so many words");
  check_bytes(line);
  read_words(line);
  if (words_.empty()) throw RequestError(ErrorCode::kBadLine, "the line is empty; help lists the commands");
  if (!admitted && !table_.known(words_[0])) refuse_without_token(words_[0]);
  const Command& command = table_.find(words_[0]);
  command_ = table_.row(command);
  const Words arguments = Words(words_).subspan(1);
  check(command, *this, arguments.size());
  renew_words(command);
  command.run(*this, arguments);
}

// Splits the line into words_. There may be half a million.
void Session::read_words(std::string_view line) {
  constexpr std::size_t kWordsBetweenLooks = 1024;
  words_.clear();
  for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
    words_.push_back(word);
    if (words_.size() % kWordsBetweenLooks == 0) pacer.breathe();
  }
}

// Replaces the old words of a request. Fields stay as they are, since the reply has their names.
void Session::renew_words(const Command& command) {
  new_words_.clear();
  if (!command.has_old) return;
  for (std::string_view& word : std::span(words_).subspan(1)) {
    const OldWord* const row = command.takes_fields ? old_field(word) : old_word(command.name, word);
    if (row == nullptr) continue;
    report_old(*row);
    if (row->is_same && !command.takes_fields) word = new_words_.emplace_back(new_word(*row, word));
  }
}

void Session::report_old(const OldWord& row) {
  if (service.old_words->add(row) && service.report_old_word)
    service.report_old_word("a client uses an old word: " + deprecation_of(row));
}

void Session::finish_reply() {
  if (!raw.empty()) append_pair(out, "raw", static_cast<std::int64_t>(raw.size()));
  out += '\n';
  out += raw;
  raw.clear();
  statistics.bytes_out += static_cast<std::int64_t>(out.size() - reply_);
  done_ = quitting || refused();
  memory.set(footprint());
  if (sharing && sharing->share().is_wanted() && sharing->share().is_due(looked_)) publish();
  if (meter_) measure();
  began_ = looked_;  // when the next request begins, if it is here
}

// The client has its reply already, or gets it at the same time as without watchers.
void Session::publish() {
  const Slot& slot = loaded->slot();
  const Environment& machine = slot.environment();
  Snapshot shown;
  shown.game = machine.game().name;
  shown.format = machine.format();
  shown.frame = machine.frame_number();
  shown.episode = episode;
  shown.score = slot.score();
  shown.reward = slot.outcome().reward;
  shown.lives = machine.lives();
  shown.action = last_action;
  shown.over = slot.finished();
  shown.screen.assign(machine.screen().begin(), machine.screen().end());
  std::ranges::copy(machine.ram(), shown.ram.begin());
  sharing->share().publish(std::move(shown), statistics.frames);
}

void Session::measure() {
  meter_->request(command_, refused_, looked_ - began_);
  meter_->frames.add(statistics.frames - metered_frames_);
  metered_frames_ = statistics.frames;
}

// The bytes of memory that the session holds. A request checks large allocations by itself; a long reply that
// may come counts already.
std::size_t Session::footprint() const {
  constexpr std::size_t kSession = std::size_t{2} << 10;  // the rest, measured
  constexpr std::size_t kShare = std::size_t{80} << 10;   // two copies of a screen
  constexpr std::size_t kLongReply = std::size_t{1} << 18;
  std::size_t reply = loaded ? View::longest_text(fields) : 0;  // that may come; only a long one counts
  if (reply < kLongReply) reply = 0;
  std::size_t bytes = kSession + std::max(reply, out.capacity() + raw.capacity()) + input.capacity() +
                      states.footprint() + machines.footprint() + actions.capacity() * sizeof(Action) +
                      step_acts.capacity() * sizeof(Act) + words_.capacity() * sizeof(std::string_view);
  if (loaded) bytes += loaded->footprint(reply > 0 ? View::most_held(fields) : 0);
  if (own_image) bytes += cartridge.image->bytes->size() + own_image->bytes();
  if (sharing) bytes += kShare;
  for (const auto& [name, watched] : watching) bytes += watched.footprint();
  return bytes;
}

std::string_view Session::whole_replies() const {
  return std::string_view(out).substr(0, pacer.in_progress() ? reply_ : out.size());
}

void Session::sent(std::size_t count) {
  out.erase(0, count);
  if (out.empty() && memory.is_short()) release();
  sent_frames_ = pacer.frames();
  sent_requests_ = statistics.requests;
  reply_ -= std::min(reply_, count);
}

void Session::cancel() {
  if (pacer.in_progress()) {
    pacer.cancel();
    drop_reply();
  }
  done_ = true;
}

void Session::rest() {
  if (pacer.in_progress()) return;
  if (loaded && sharing) publish();  // a session that pauses shows what it stopped at
  release();
}

// Releases what the next request can make again.
void Session::release() {
  if (pacer.in_progress()) return;  // the request, whose words are in use, waits for its client to read
  if (loaded) loaded->rest();
  machines.rest();
  if (out.empty()) discard(out);
  discard(raw);
  discard(actions, actions.capacity() * sizeof(Action));
  std::vector<Act>().swap(step_acts);
  std::vector<std::string_view>().swap(words_);
  memory.set(footprint());
}

}  // namespace racebeam
