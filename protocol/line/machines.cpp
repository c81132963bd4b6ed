#include "protocol/line/machines.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <utility>

#include "environment/settings/play_settings.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "protocol/line/session_log.hpp"
#include "protocol/line/session_recording.hpp"
#include "protocol/request_error.hpp"

namespace racebeam {
namespace {

struct Seat {
  Pacer pacer;
  std::optional<View> view;
  bool done = false;            // has finished the request
  std::exception_ptr no_fiber;  // why its fiber could not start; else null
  std::string text, raw;        // the machine's part of the reply; members to reuse their memory
};

}  // namespace

// Each machine writes its part of the reply into its own Seat, since machines run on several threads.
class Machines::Host final : public VectorHost {
 public:
  Host(Context& context, std::size_t count) : context_(context), seats_(count) {
    for (auto& seat : seats_) seat = std::make_unique<Seat>();
  }

  Seat& seat(std::size_t number) { return *seats_[number]; }
  void observe(std::size_t number, const std::vector<Field>& fields);  // begins a view of them
  std::span<const std::unique_ptr<Seat>> seats() const { return seats_; }
  std::size_t held() const;               // bytes of memory of the machines' parts of replies
  std::vector<std::string> take_texts();  // those parts

  void run_all(std::size_t count, const std::function<void(std::size_t)>& task) override;
  Pace* pace(std::size_t number) override { return &seats_[number]->pacer; }

  void opened(std::size_t number, Slot& slot) override {
    racebeam::observe(slot, context_.fields);
    observe(number, context_.fields);
  }
  void ended(std::size_t number, const Slot& slot) override {
    seats_[number]->view->append_final(seats_[number]->text, seats_[number]->raw, slot);
  }
  void show(std::size_t number, const Slot& slot) override {
    seats_[number]->view->append(seats_[number]->text, seats_[number]->raw, slot);
  }

 private:
  std::int64_t frames() const;
  void work_on(Seat& seat, std::size_t number, const std::function<void(std::size_t)>& task,
               Pacer::Clock::time_point end);

  Context& context_;
  std::vector<std::unique_ptr<Seat>> seats_;
};

struct Machines::Opened {
  Opened(Context& context, std::size_t count, const SlotSettings& settings, Autoreset autoreset,
         std::size_t reply)
      : host(context, count),
        vector(std::vector<Cartridge>(count, context.game.cartridge), settings, autoreset, host),
        reply_bytes(reply) {}

  Host host;
  VectorEnvironment vector;
  std::size_t reply_bytes;  // estimated length of a reply
};

Machines::Machines(Context& context) : context_(context) {}
Machines::~Machines() = default;

std::size_t Machines::size() const { return opened_ ? opened_->vector.size() : 0; }
Slot& Machines::slot(std::size_t number) { return opened_->vector.slot(number); }
Pacer& Machines::pacer(std::size_t number) { return opened_->host.seat(number).pacer; }

void Machines::close() {
  if (empty()) return;
  context_.discard(opened_, footprint());
}

std::size_t Machines::number_of(std::string_view text) const {
  if (empty()) throw RequestError(ErrorCode::kNoMachines, "machine= needs machines; open some first");
  return static_cast<std::size_t>(number_within(text, "machine", 0, static_cast<std::int64_t>(size()) - 1));
}

void Machines::add_view(std::size_t number, Reply& reply) {
  reply.add_fields([&](std::string& out, std::string& raw) {
    opened_->host.seat(number).view->append(out, raw, slot(number));
  });
}

void Machines::observe(const std::vector<Field>& fields) {
  if (empty()) return;
  opened_->reply_bytes = check(fields, size(), opened_->vector.autoreset());
  for (std::size_t number = 0; number < size(); ++number) {
    racebeam::observe(opened_->vector.slot(number), fields);
    opened_->host.observe(number, fields);
    context_.pacer.yield_if_due();
  }
}

void Machines::release_caches() {
  if (empty()) return;
  const std::size_t bytes = opened_->host.held();
  for (std::size_t number = 0; number < size(); ++number) {
    Seat& seat = opened_->host.seat(number);
    slot(number).environment().release_caches();
    seat.view->release_caches();
  }
  auto texts = opened_->host.take_texts();
  context_.discard(texts, bytes);
}

// Checks whether `count` machines with these fields are possible. Throws RequestError if their replies would
// exceed the limit, or if memory does not suffice. Returns the estimated length of a reply in bytes.
std::size_t Machines::check(const std::vector<Field>& fields, std::size_t count, Autoreset autoreset) {
  const Environment& machine = context_.game.loaded->machine();
  const std::size_t once = text_size(fields, machine);
  const std::size_t reply = count * (autoreset == Autoreset::kSameStep ? 2 * once : once);
  context_.check_reply(reply, std::to_string(count) + " machines with these fields");
  const std::size_t each = sizeof(Seat) + LoadedMachine::max_footprint(fields) + machine.cartridge_ram_size();
  context_.memory.check(count * each + 2 * reply, std::to_string(count) + " machines with these fields");
  return reply;
}

std::size_t Machines::footprint() const {
  if (empty()) return 0;
  std::size_t bytes = opened_->host.held();
  for (std::size_t number = 0; number < size(); ++number) {
    const Seat& seat = opened_->host.seat(number);
    bytes += sizeof seat + machine_memory(opened_->vector.slot(number)) + seat.view->footprint();
  }
  return bytes;
}

// A reply is put together from the machines' parts of it, which may have kept their memory.
void Machines::check_reply_memory() const {
  const std::size_t reply = opened_->reply_bytes;
  context_.memory.check(2 * reply - std::min(reply, opened_->host.held()), "the reply");
}

void Machines::open(std::size_t count, const SlotSettings& settings, Autoreset autoreset, Reply& reply) {
  const std::size_t reply_bytes = check(context_.fields, count, autoreset);
  context_.allow_resets(count);
  auto opened = std::make_unique<Opened>(context_, count, settings, autoreset, reply_bytes);
  context_.stop_recording_machines();
  close();
  opened_ = std::move(opened);
  reply.add("machines", static_cast<std::int64_t>(count));
  reply.add("autoreset", name_of(autoreset));
  add_texts(reply);
}

void Machines::step(std::span<const Act> acts, Reply& reply) {
  const std::vector<std::uint8_t> resets(size(), opened_->vector.autoreset() != Autoreset::kDisabled);
  check_frames(static_cast<std::int64_t>(size()), resets);
  check_reply_memory();
  opened_->vector.step(acts);
  reply.add("machines", static_cast<std::int64_t>(size()));
  add_cut(context_, reply);
  add_log_cut(context_, reply);
  add_texts(reply);
  for (std::size_t number = 0; number < size(); ++number)
    context_.count(opened_->vector.slot(number).outcome());
}

void Machines::restart(std::span<const std::uint8_t> mask, std::span<const std::int64_t> seeds,
                       Reply& reply) {
  check_frames(0, mask);
  check_reply_memory();
  opened_->vector.reset(mask, seeds);
  reply.add("machines", static_cast<std::int64_t>(size()));
  add_texts(reply);
}

// Assumes that a reset takes as long as the machine's longest one so far.
void Machines::check_frames(std::int64_t acts, std::span<const std::uint8_t> resets) const {
  std::int64_t frames = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (resets[i] != 0)
      frames += std::max<std::int64_t>(opened_->vector.slot(i).reset_frames() - kFreeResetFrames, 0);
  }
  context_.check_frames(acts, frames);
}

void Machines::add_texts(Reply& reply) {
  std::size_t text = 0, raw = 0;
  for (const auto& seat : opened_->host.seats()) {
    text += 2 + seat->text.size();
    raw += seat->raw.size();
  }
  reply.reserve(text, raw);  // at once: a long reply that grows by doubling is copied in one piece
  for (const auto& seat : opened_->host.seats()) {
    reply.add_group();
    reply.add_fields([&](std::string& out, std::string& more) {
      out += seat->text;
      more += seat->raw;
    });
    context_.pacer.yield_if_due();
  }
}

// Long values are written in the machine's own work, or in that of a request about only this machine.
void Machines::Host::observe(std::size_t number, const std::vector<Field>& fields) {
  seats_[number]->view.emplace(fields, [this, &own = seats_[number]->pacer] {
    (own.in_progress() ? own : context_.pacer).yield_if_due();
  });
}

std::size_t Machines::Host::held() const {
  std::size_t bytes = 0;
  for (const auto& seat : seats_) bytes += seat->text.capacity() + seat->raw.capacity();
  return bytes;
}

std::vector<std::string> Machines::Host::take_texts() {
  std::vector<std::string> texts;
  for (const auto& seat : seats_) {
    texts.push_back(std::exchange(seat->text, {}));
    texts.push_back(std::exchange(seat->raw, {}));
  }
  return texts;
}

std::int64_t Machines::Host::frames() const {
  std::int64_t frames = 0;
  for (const auto& seat : seats_) frames += seat->pacer.frames();
  return frames;
}

// Works in rounds that last a slice each; the session yields between them. A machine begins only while its
// round lasts, so that at most as many machines as threads are in progress. The first machine of a round
// always begins.
void Machines::Host::run_all(std::size_t count, const std::function<void(std::size_t)>& task) {
  struct Guard {  // cancels all fibers, so that the task does not outlive this call
    ~Guard() {
      for (const auto& seat : of) seat->pacer.cancel();
    }
    std::span<const std::unique_ptr<Seat>> of;
  };
  const Guard guard{seats_};
  for (const auto& seat : seats_) {
    seat->done = false;
    seat->no_fiber = nullptr;
    seat->text.clear();
    seat->raw.clear();
  }
  std::int64_t counted = frames();
  for (std::size_t first = 0;;) {  // the first machine that is not done
    const auto end = context_.pacer.end();
    context_.run_parallel(count - first, [&](std::size_t i) {
      Seat& seat = *seats_[first + i];
      const bool begins = i == 0 || seat.pacer.in_progress() || Pacer::Clock::now() < end;
      if (!seat.done && begins) work_on(seat, first + i, task, end);
    });
    context_.pacer.count(frames() - counted);
    counted = frames();
    while (first < count && seats_[first]->done) ++first;
    if (first == count) break;
    context_.pacer.pause();
  }
  for (const auto& seat : seats_) {
    if (seat->no_fiber) std::rethrow_exception(seat->no_fiber);
  }
}

// Runs on any thread, and accesses only its own seat.
void Machines::Host::work_on(Seat& seat, std::size_t number, const std::function<void(std::size_t)>& task,
                             Pacer::Clock::time_point end) {
  try {
    seat.done = seat.pacer.work(end, [number, &task] { task(number); });
  } catch (const std::bad_alloc&) {
    seat.no_fiber = std::current_exception();
    seat.done = true;
  }
}

}  // namespace racebeam
