#include "protocol/line/session_recording.hpp"

#include <utility>

#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"

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

std::optional<Recording::Cut> SessionRecording::new_cut() {
  const auto cut = recording_->cut();
  return cut && !std::exchange(has_reported_, true) ? cut : std::nullopt;
}

void add_cut(Context& context, Reply& reply) {
  if (!context.media.recording) return;
  if (const auto cut = context.media.recording->new_cut()) reply.add("recording_ended", name_of(*cut));
}

void await(const Recording& recording, Pacer& pacer) {
  while (recording.is_behind()) pacer.pause();
}

}  // namespace racebeam
