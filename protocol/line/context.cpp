#include "protocol/line/context.hpp"

#include <algorithm>
#include <array>

#include "protocol/line/session_log.hpp"
#include "protocol/line/session_recording.hpp"
#include "protocol/request_error.hpp"

namespace racebeam {
namespace {

constexpr std::array<std::string_view, 4> kFirstFields = {"reward", "terminated", "truncated", "lives"};

}  // namespace

Context::Context(const LineService& with, const std::shared_ptr<MemoryBudget>& budget)
    : service(with),
      peer{.admitted = !with.admission},
      memory(budget ? budget : with.memory),
      fields(parse_fields(kFirstFields)),
      machines(*this) {}

// The fiber and the recording use the other members, so they are destroyed first.
Context::~Context() { leave(); }

void Context::leave() {
  pacer.cancel();
  media = {};
  sharing.reset();
  watching.clear();
}

void Context::discard(std::string& text) {
  const std::size_t bytes = text.capacity();
  dispose(service.disposal, service.memory, bytes, LongText(std::exchange(text, {})));
}

void Context::check_frames(std::int64_t acts, std::int64_t frames) const {
  const Settings& machine = game.settings.machine;
  frames += acts * std::max(machine.frame_skip, machine.frame_skip_max);
  const std::int64_t most = service.limits.request_frames;
  if (frames <= most) return;
  throw RequestError(ErrorCode::kLimit, "the request asks for " + std::to_string(frames) +
                                            " frames; it may ask for " + std::to_string(most));
}

void Context::check_audio(std::int64_t acts) const {
  const Settings& machine = game.settings.machine;
  const std::int64_t frames = acts * std::max(machine.frame_skip, machine.frame_skip_max);
  if (frames <= kMaxFrameSkip) return;
  throw RequestError(ErrorCode::kLimit, "the request asks for audio_all of " + std::to_string(frames) +
                                            " frames; it may ask for " + std::to_string(kMaxFrameSkip));
}

void Context::allow_resets(std::size_t count) {
  pacer.allow_frames(service.limits.request_frames + kFreeResetFrames * static_cast<std::int64_t>(count));
}

void Context::check_reply(std::size_t bytes, const std::string& about) const {
  const std::size_t most = service.limits.reply;
  if (bytes <= most) return;
  throw RequestError(ErrorCode::kLimit, "a reply about " + about + " would have about " +
                                            std::to_string(bytes) + " bytes; it may have " +
                                            std::to_string(most));
}

void Context::count(const Outcome& outcome) {
  statistics.acts += outcome.acts;
  statistics.frames += outcome.frames;
  statistics.episodes += outcome.frames > 0 && (outcome.terminated || outcome.truncated);
}

void Context::stop_recording_machines() {
  const Slot& loaded = game.loaded->slot();
  if (media.recording && !media.recording->shows(loaded)) media.recording.reset();
  if (media.log && !media.log->shows(loaded)) media.log.reset();
}

void Context::drop_log(std::string why) {
  if (media.log && media.log->shows(game.loaded->slot())) media.log->drop_log(std::move(why));
}

void Context::run_parallel(std::size_t count, const std::function<void(std::size_t)>& task) const {
  if (service.parallel) return service.parallel(count, task);
  for (std::size_t number = 0; number < count; ++number) task(number);
}

void Context::publish() {
  const Slot& slot = game.loaded->slot();
  const Environment& machine = slot.environment();
  Snapshot snapshot;
  snapshot.game = machine.game().name;
  snapshot.format = machine.format();
  snapshot.frame = machine.frame_number();
  snapshot.episode = game.episode;
  snapshot.score = slot.score();
  snapshot.reward = slot.outcome().reward;
  snapshot.lives = machine.lives();
  snapshot.action = game.last_action;
  snapshot.over = slot.finished();
  snapshot.screen.assign(machine.screen().begin(), machine.screen().end());
  std::ranges::copy(machine.ram(), snapshot.ram.begin());
  sharing->share().publish(std::move(snapshot), statistics.frames);
}

void Context::release_caches() {
  if (game.loaded) game.loaded->release_caches();
  machines.release_caches();
  discard(scratch.actions, scratch.actions.capacity() * sizeof(Action));
  std::vector<Act>().swap(scratch.acts);
}

bool Context::waits_for_disk() const {
  return (media.recording && media.recording->is_behind()) || (media.picture && media.picture->is_behind()) ||
         (media.log && media.log->is_awaited());
}

std::size_t Context::footprint() const {
  constexpr std::size_t kShare = std::size_t{80} << 10;  // two copies of a screen
  std::size_t bytes = game.states.footprint() + machines.footprint() +
                      scratch.actions.capacity() * sizeof(Action) + scratch.acts.capacity() * sizeof(Act);
  if (game.own_image) bytes += game.cartridge.image->bytes->size() + game.own_image->bytes();
  if (media.log) bytes += media.log->footprint();
  if (sharing) bytes += kShare;
  for (const auto& [name, watched] : watching) bytes += watched.footprint();
  return bytes;
}

}  // namespace racebeam
