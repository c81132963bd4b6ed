#include "protocol/line/session_recording.hpp"

#include <utility>

#include "protocol/line/words.hpp"

namespace racebeam {

SessionRecording::SessionRecording(std::shared_ptr<Recording> recording, Slot& slot, Pacer& pacer)
    : recording_(std::move(recording)), slot_(slot), pacer_(pacer) {
  watch();
}

SessionRecording::~SessionRecording() { slot_.environment().watch({}); }

void SessionRecording::watch() {
  slot_.environment().watch([this] {
    if (slot_.begins()) return;
    await(*recording_, pacer_);
    recording_->add(slot_.environment());
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
