// The recording that `record` starts in a session: each frame of an act of its machine is sent to the
// recorder.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "environment/vector/slot.hpp"
#include "protocol/running/pacer.hpp"
#include "recording/recording.hpp"

namespace racebeam {

class Context;
class Reply;

class SessionRecording {
 public:
  // Watches the machine of the slot, which outlives it, as `pacer` does, on which it runs.
  SessionRecording(std::shared_ptr<Recording> recording, Slot& slot, Pacer& pacer);
  ~SessionRecording();  // keeps what was recorded, without waiting for it
  SessionRecording(const SessionRecording&) = delete;
  SessionRecording& operator=(const SessionRecording&) = delete;

  void watch();  // the machine, again
  bool shows(const Slot& slot) const { return &slot == &slot_; }
  bool is_behind() const { return recording_->is_behind(); }
  Recording& recording() { return *recording_; }
  const std::string& names() const { return recording_->names(); }

  // Returns what has cut it off: once, as soon as that is known.
  std::optional<Recording::Cut> new_cut();

 private:
  std::shared_ptr<Recording> recording_;
  Slot& slot_;
  Pacer& pacer_;
  bool has_reported_ = false;
};

// Notes in the reply, once, that the session's recording was cut off.
void add_cut(Context& context, Reply& reply);

// Suspends the body of `pacer` until the recording has begun, has room for a frame, or has finished.
void await(const Recording& recording, Pacer& pacer);

}  // namespace racebeam
