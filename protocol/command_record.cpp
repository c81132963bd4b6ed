// record
#include "protocol/recording.hpp"

#include <array>

#include "games/similar.hpp"
#include "protocol/command.hpp"
#include "protocol/session.hpp"

namespace racebeam {
namespace {

void stop(Session& session) {
  if (!session.recording) throw Refusal(Code::kRecording, "nothing is being recorded");
  const auto recording = std::move(session.recording);
  session.watch();
  try {
    recording->stop();
  } catch (const std::runtime_error& error) {
    throw Refusal(Code::kRecording, error.what());
  }
  session.out += "ok";
  append_pair(session.out, "recorded", recording->name());
  append_pair(session.out, "frames", recording->frames());
  append_pair(session.out, "bytes", static_cast<std::int64_t>(recording->bytes()));
}

void start(Session& session, MediaKind kind, std::string_view name) {
  const LineService& service = session.service;
  if (service.record_folder.empty())
    throw Refusal(Code::kRecording, "this server does not record; it was started without --record-dir");
  if (session.recording)
    throw Refusal(Code::kRecording, session.recording->name() + " is being recorded; record stop ends it");
  try {
    session.recording =
        std::make_unique<Recording>(kind, service.record_folder, std::string(checked_name(name, "recording")),
                                    service.limits.recording, session.player->machine());
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const Refusal*>(&error) != nullptr) throw;
    throw Refusal(Code::kRecording, error.what());
  }
  session.watch();
  session.out += "ok";
  append_pair(session.out, "recording", session.recording->name());
}

}  // namespace

void run_record(Session& session, Words arguments) {
  if (arguments[0] == "stop" && arguments.size() == 1) return stop(session);
  const auto kind = media_kind(arguments[0]);
  if (!kind || arguments.size() != 2) {
    constexpr std::array<std::string_view, 5> kKinds = {"png", "gif", "y4m", "wav", "stop"};
    const std::string meant = kind ? "" : did_you_mean(arguments[0], kKinds);
    throw Refusal(Code::kBadArguments, "record takes png, gif, y4m or wav and a name, or stop" +
                                           (meant.empty() ? meant : ';' + meant));
  }
  start(session, *kind, arguments[1]);
}

}  // namespace racebeam
