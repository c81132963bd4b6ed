// record, shot
#include <algorithm>
#include <array>
#include <optional>

#include "protocol/encoding/base64.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "protocol/line/session_recording.hpp"
#include "protocol/request_error.hpp"
#include "recording/footage.hpp"
#include "recording/png.hpp"
#include "recording/recorder.hpp"
#include "system/similar.hpp"

namespace racebeam {
namespace {

constexpr std::string_view kTaken =
    "record takes png, gif, y4m, wav, webm, mp4 or several as in y4m,wav, and a name, or stop";
constexpr std::array<std::string_view, 7> kWords = {"png", "gif", "y4m", "wav", "webm", "mp4", "stop"};

void stop(Context& context, Reply& reply) {
  if (!context.media.recording) throw RequestError(ErrorCode::kRecording, "nothing is being recorded");
  Recording& recording = context.media.recording->recording();
  recording.finish();
  await(recording, context.pacer);
  const auto ended = std::move(context.media.recording);
  const Recording::Result& result = recording.result();
  if (result.names.empty()) throw RequestError(ErrorCode::kRecording, result.failure + "; nothing was kept");
  reply.add("recorded", result.names);
  reply.add("frames", result.frames);
  reply.add("bytes", static_cast<std::int64_t>(result.bytes));
  reply.add("complete", recording.cut() ? 0 : 1);
  if (const auto cut = recording.cut()) reply.add("recording_ended", name_of(*cut));
}

std::vector<MediaKind> parse_kinds(std::string_view words) {
  std::vector<MediaKind> kinds;
  bool more = true;
  while (more) {
    more = words.find(',') != words.npos;
    const std::string_view rest = cut_behind(words, ',');
    const auto kind = media_kind(words);
    if (!kind) {
      const std::string similar = did_you_mean(words, kWords);
      throw RequestError(ErrorCode::kBadArguments,
                         std::string(kTaken) + (similar.empty() ? similar : ';' + similar));
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
Subject subject_of(Context& context, std::optional<std::string_view> text) {
  if (!text) return {context.game.loaded->slot(), context.game.loaded->pacer()};
  const std::size_t number = context.machines.number_of(*text);
  return {context.machines.slot(number), context.machines.pacer(number)};
}

// Charges the server, because a slow write may outlive the session by far.
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

void start(Context& context, const std::vector<MediaKind>& kinds, std::string_view name, Subject subject,
           Reply& reply) {
  const auto recording = begin(context.service, kinds, name, subject.slot.environment());
  context.media.recording = std::make_unique<SessionRecording>(recording, subject.slot, subject.pacer);
  await(*recording, context.pacer);
  if (recording->finished()) {
    context.media.recording.reset();
    throw RequestError(ErrorCode::kRecording, recording->result().failure);
  }
  reply.add("recording", recording->names());
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

void add_size(Reply& reply, const Environment& machine, std::size_t bytes) {
  reply.add("width", static_cast<std::int64_t>(kPictureWidth));
  reply.add("height", machine.height());
  reply.add("bytes", static_cast<std::int64_t>(bytes));
}

void write_picture(Context& context, std::string_view name, const Environment& machine, Reply& reply) {
  const auto picture = context.media.picture = begin(context.service, {MediaKind::kPicture}, name, machine);
  await(*picture, context.pacer);
  if (!picture->finished()) picture->add(machine);
  picture->finish();
  await(*picture, context.pacer);
  context.media.picture.reset();
  const Recording::Result& result = picture->result();
  if (result.names.empty()) throw RequestError(ErrorCode::kRecording, result.failure);
  reply.add("picture", result.names);
  add_size(reply, machine, result.bytes);
}

void hand_over_picture(Context& context, const Environment& machine, Reply& reply) {
  const auto pixels = machine.screen();
  constexpr std::size_t kBytesOfPixel = 8;  // rows, packed rows, the file and its text
  context.memory.check(kBytesOfPixel * pixels.size(), "a picture");
  PngWriter writer(footage_of(machine));
  const auto file = writer.file(pixels);
  context.check_reply(text_size(Encoding::kBase64, file.size()), "a picture");
  add_size(reply, machine, file.size());
  append_base64(reply.add_long("data"), file);
}

}  // namespace

void run_record(Context& context, Words arguments, Reply& reply) {
  if (arguments[0] == "stop" && arguments.size() == 1) return stop(context, reply);
  const auto kinds = parse_kinds(arguments[0]);
  if (arguments.size() < 2) throw RequestError(ErrorCode::kBadArguments, std::string(kTaken));
  if (!context.service.recorder)
    throw RequestError(ErrorCode::kRecording,
                       "this server does not record; it was started without --record-dir");
  if (context.media.recording)
    throw RequestError(ErrorCode::kRecording,
                       context.media.recording->names() + " is still being recorded; record stop ends it");
  const std::string_view name = checked_name(arguments[1], "recording");
  std::optional<std::string_view> machine;
  if (arguments.size() > 2) machine = value_of(arguments[2], "machine", "record");
  start(context, kinds, name, subject_of(context, machine), reply);
}

void run_shot(Context& context, Words arguments, Reply& reply) {
  const ShotWords words = shot_words(arguments);
  const Environment& machine = subject_of(context, words.machine).slot.environment();
  if (words.name && context.service.recorder) return write_picture(context, *words.name, machine, reply);
  hand_over_picture(context, machine, reply);
}

}  // namespace racebeam
