// record, shot
#include <algorithm>
#include <array>
#include <optional>

#include "games/similar.hpp"
#include "protocol/encoding/base64.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/session.hpp"
#include "protocol/line/session_recording.hpp"
#include "recording/footage.hpp"
#include "recording/png.hpp"
#include "recording/recorder.hpp"

namespace racebeam {
namespace {

constexpr std::string_view kTaken =
    "record takes png, gif, y4m, wav, webm, mp4 or several as in y4m,wav, and a name, or stop";
constexpr std::array<std::string_view, 7> kWords = {"png", "gif", "y4m", "wav", "webm", "mp4", "stop"};

void stop(Session& session) {
  if (!session.recording) throw RequestError(ErrorCode::kRecording, "nothing is being recorded");
  Recording& recording = session.recording->recording();
  recording.finish();
  await(recording, session.pacer);
  const auto ended = std::move(session.recording);
  const Recording::Result& result = recording.result();
  if (result.names.empty()) throw RequestError(ErrorCode::kRecording, result.failure + "; nothing was kept");
  session.out += "ok";
  append_pair(session.out, "recorded", result.names);
  append_pair(session.out, "frames", result.frames);
  append_pair(session.out, "bytes", static_cast<std::int64_t>(result.bytes));
  append_pair(session.out, "complete", recording.cut() ? 0 : 1);
  if (const auto cut = recording.cut()) append_pair(session.out, "recording_ended", name_of(*cut));
}

std::vector<MediaKind> parse_kinds(std::string_view words) {
  std::vector<MediaKind> kinds;
  bool more = true;
  while (more) {
    more = words.find(',') != words.npos;
    const std::string_view rest = cut_behind(words, ',');
    const auto kind = media_kind(words);
    if (!kind) {
      const std::string meant = did_you_mean(words, kWords);
      throw RequestError(ErrorCode::kBadArguments,
                         std::string(kTaken) + (meant.empty() ? meant : ';' + meant));
    }
    if (std::ranges::find(kinds, *kind) != kinds.end()) refuse_twice(words);
    kinds.push_back(*kind);
    words = rest;
  }
  return kinds;
}

struct Subject {  // of a recording
  Slot& slot;
  Pacer& pacer;  // on which it runs
};

// One of the machines of `open`, or without a number the machine of `load`.
Subject subject_of(Session& session, std::optional<std::string_view> text) {
  if (!text) return {session.loaded->slot(), session.loaded->pacer()};
  const std::size_t number = session.machines.number_of(*text);
  return {session.machines.slot(number), session.machines.pacer(number)};
}

// To the server. What is written slowly may outlive the session by far.
std::shared_ptr<const void> charge(const LineService& service, std::size_t bytes) {
  const auto share = std::make_shared<MemoryShare>(service.memory);
  share->check(bytes, "a recording");
  return share;
}

std::shared_ptr<Recording> begin(const LineService& service, const std::vector<MediaKind>& kinds,
                                 std::string_view name, const Environment& machine) {
  try {
    return service.recorder->begin(kinds, std::string(name), service.limits.recording, machine,
                                   [&service](std::size_t bytes) { return charge(service, bytes); });
  } catch (const RequestError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw RequestError(ErrorCode::kRecording, error.what());
  }
}

void start(Session& session, const std::vector<MediaKind>& kinds, std::string_view name, Subject subject) {
  const auto recording = begin(session.service, kinds, name, subject.slot.environment());
  session.recording = std::make_unique<SessionRecording>(recording, subject.slot, subject.pacer);
  await(*recording, session.pacer);
  if (recording->finished()) {
    session.recording.reset();
    throw RequestError(ErrorCode::kRecording, recording->result().failure);
  }
  session.out += "ok";
  append_pair(session.out, "recording", recording->names());
}

// The words of `shot`, in any order.
struct ShotWords {
  std::optional<std::string_view> name, machine;
};

ShotWords shot_words(Words arguments) {
  ShotWords words;
  for (const std::string_view word : arguments) {
    const bool is_pair = word.find('=') != word.npos;
    auto& place = is_pair ? words.machine : words.name;
    if (place) refuse_twice(is_pair ? "machine" : "the name of the picture");
    place = is_pair ? value_of(word, "machine", "shot") : checked_name(word, "picture");
  }
  return words;
}

void append_size(std::string& out, const Environment& machine, std::size_t bytes) {
  append_pair(out, "width", static_cast<std::int64_t>(kPictureWidth));
  append_pair(out, "height", machine.height());
  append_pair(out, "bytes", static_cast<std::int64_t>(bytes));
}

void write_picture(Session& session, std::string_view name, const Environment& machine) {
  const auto picture = session.picture = begin(session.service, {MediaKind::kPicture}, name, machine);
  await(*picture, session.pacer);
  if (!picture->finished()) picture->add(machine);
  picture->finish();
  await(*picture, session.pacer);
  session.picture.reset();
  const Recording::Result& result = picture->result();
  if (result.names.empty()) throw RequestError(ErrorCode::kRecording, result.failure);
  session.out += "ok";
  append_pair(session.out, "picture", result.names);
  append_size(session.out, machine, result.bytes);
}

void hand_over_picture(Session& session, const Environment& machine) {
  const auto pixels = machine.screen();
  constexpr std::size_t kBytesOfPixel = 8;  // rows, packed rows, the file and its text
  session.memory.check(kBytesOfPixel * pixels.size(), "a picture");
  PngWriter writer(footage_of(machine));
  const auto file = writer.file(pixels);
  session.check_reply(text_size(Encoding::kBase64, file.size()), "a picture");
  session.out += "ok";
  append_size(session.out, machine, file.size());
  append_pair(session.out, "data", "");
  append_base64(session.out, file);
}

}  // namespace

void run_record(Session& session, Words arguments) {
  if (arguments[0] == "stop" && arguments.size() == 1) return stop(session);
  const auto kinds = parse_kinds(arguments[0]);
  if (arguments.size() < 2) throw RequestError(ErrorCode::kBadArguments, std::string(kTaken));
  if (!session.service.recorder)
    throw RequestError(ErrorCode::kRecording,
                       "this server does not record; it was started without --record-dir");
  if (session.recording)
    throw RequestError(ErrorCode::kRecording,
                       session.recording->names() + " has not been stopped; record stop does it");
  const std::string_view name = checked_name(arguments[1], "recording");
  std::optional<std::string_view> machine;
  if (arguments.size() > 2) machine = value_of(arguments[2], "machine", "record");
  start(session, kinds, name, subject_of(session, machine));
}

void run_shot(Session& session, Words arguments) {
  const ShotWords words = shot_words(arguments);
  const Environment& machine = subject_of(session, words.machine).slot.environment();
  if (words.name && session.service.recorder) return write_picture(session, *words.name, machine);
  hand_over_picture(session, machine);
}

}  // namespace racebeam
