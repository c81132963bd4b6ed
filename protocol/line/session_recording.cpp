#include "protocol/line/session_recording.hpp"

#include <utility>

#include "protocol/line/words.hpp"

namespace racebeam {

SessionRecording::SessionRecording(std::shared_ptr<Recording> recording, Player& player)
    : recording_(std::move(recording)), player_(player) {
  watch();
}

SessionRecording::~SessionRecording() { player_.machine().watch({}); }

void SessionRecording::watch() {
  player_.machine().watch([this] {
    await(*recording_, player_.pacer());
    recording_->add(player_.machine());
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
