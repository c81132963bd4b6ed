#include "protocol/line/session_recording.hpp"

#include <utility>

#include "protocol/line/words.hpp"

namespace racebeam {

SessionRecording::SessionRecording(std::shared_ptr<Recording> recording, Environment& machine, Pacer& pacer)
    : recording_(std::move(recording)), machine_(machine), pacer_(pacer) {
  watch();
}

SessionRecording::~SessionRecording() { machine_.watch({}); }

void SessionRecording::watch() {
  machine_.watch([this] {
    await(*recording_, pacer_);
    recording_->add(machine_);
  });
}

void SessionRecording::append_cut(std::string& out) {
  const auto cut = recording_->cut();
  if (cut && !std::exchange(told_, true)) append_pair(out, "recording_ended", name_of(*cut));
}

void await(const Recording& recording, Pacer& pacer) {
  while (recording.is_behind()) pacer.pause();
}

}  // namespace racebeam
