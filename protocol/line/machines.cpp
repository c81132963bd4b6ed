#include "protocol/line/machines.hpp"

#include <algorithm>
#include <array>

#include "protocol/line/session.hpp"

namespace racebeam {
namespace {

constexpr std::array<std::string_view, 3> kAutoresets = {"next-step", "same-step", "disabled"};

}  // namespace

std::span<const std::string_view> autoresets() { return kAutoresets; }

std::string_view name_of(Autoreset autoreset) { return kAutoresets[static_cast<std::size_t>(autoreset)]; }

void Machines::observe(Session& session, const std::vector<Field>& fields) {
  if (empty()) return;
  reply_bytes_ = check(session, fields, size(), autoreset_);
  for (const auto& seat : seats_) seat->player->observe(fields);
}

void Machines::rest() {
  for (const auto& seat : seats_) {
    seat->player->machine().rest();
    std::string().swap(seat->text);
  }
}

// Each machine's part of a reply is made by itself before it is put into the whole.
std::size_t Machines::check(Session& session, const std::vector<Field>& fields, std::size_t count,
                            Autoreset autoreset) {
  const std::size_t once = text_size(fields, session.player->machine());
  const std::size_t reply = count * (autoreset == Autoreset::kSameStep ? 2 * once : once);
  session.check_reply(reply, std::to_string(count) + " machines with these fields");
  session.memory.check(count * (sizeof(Seat) + Player::footprint(fields)) + 2 * reply,
                       std::to_string(count) + " machines with these fields");
  return reply;
}

std::size_t Machines::footprint(const std::vector<Field>& fields) const {
  std::size_t bytes = size() * (sizeof(Seat) + (empty() ? 0 : Player::footprint(fields)));
  for (const auto& seat : seats_) bytes += seat->text.capacity();
  return bytes;
}

void Machines::open(Session& session, std::size_t count, Autoreset autoreset) {
  const std::size_t reply_bytes = check(session, session.fields, count, autoreset);
  Seats seats(count);
  for (auto& seat : seats) seat = std::make_unique<Seat>();
  session.allow_resets(count);
  work_on_all(session, seats, [&session](Seat& seat, std::size_t number) {
    PlaySettings settings = session.settings;
    settings.machine.random_seed += static_cast<std::uint32_t>(number);
    seat.player = std::make_unique<Player>(session.cartridge, settings, session.fields, seat.pacer);
    seat.player->begin_request();
    seat.tell();
  });
  session.stop_recording_machines();
  seats_.swap(seats);
  autoreset_ = autoreset;
  reply_bytes_ = reply_bytes;
  session.out += "ok";
  append_pair(session.out, "machines", static_cast<std::int64_t>(count));
  append_pair(session.out, "autoreset", name_of(autoreset));
  append_texts(session);
}

void Machines::step(Session& session, std::span<const Action> actions) {
  const std::vector<std::uint8_t> resets(size(), autoreset_ != Autoreset::kDisabled);
  check_frames(session, static_cast<std::int64_t>(size()), resets);
  session.memory.check(reply_bytes_, "the reply");
  work_on_all(session, seats_, [this, actions](Seat& seat, std::size_t number) {
    seat.player->begin_request();
    seat.step(actions[number], autoreset_);
    seat.tell();
  });
  session.out += "ok";
  append_pair(session.out, "machines", static_cast<std::int64_t>(size()));
  session.append_cut();
  append_texts(session);
  for (const auto& seat : seats_) session.count(seat->player->outcome());
}

void Machines::restart(Session& session, std::span<const std::uint8_t> chosen) {
  check_frames(session, 0, chosen);
  session.memory.check(reply_bytes_, "the reply");
  work_on_all(session, seats_, [chosen](Seat& seat, std::size_t number) {
    seat.player->begin_request();
    if (chosen[number] != 0) seat.player->reset();
    seat.tell();
  });
  session.out += "ok";
  append_pair(session.out, "machines", static_cast<std::int64_t>(size()));
  append_texts(session);
}

// A reset is taken to last as long as the machine's longest one so far.
void Machines::check_frames(const Session& session, std::int64_t acts,
                            std::span<const std::uint8_t> resets) const {
  std::int64_t frames = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (resets[i] != 0)
      frames += std::max<std::int64_t>(seats_[i]->player->reset_frames() - kFreeResetFrames, 0);
  }
  session.check_frames(acts, frames);
}

std::int64_t Machines::frames_of(const Seats& seats) {
  std::int64_t frames = 0;
  for (const auto& seat : seats) frames += seat->pacer.frames();
  return frames;
}

// Rounds of a slice each; the session yields between them. A machine begins only while its round lasts, so
// that no more machines are in progress than there are threads. The first begins in any case.
void Machines::work_on_all(Session& session, Seats& seats, const Task& task) {
  struct Guard {  // the task does not outlive this call
    ~Guard() {
      for (const auto& seat : of) seat->pacer.cancel();
    }
    Seats& of;
  };
  const Guard guard{seats};
  for (const auto& seat : seats) {
    seat->done = false;
    seat->failure = nullptr;
    seat->text.clear();
  }
  std::int64_t counted = frames_of(seats);
  for (std::size_t first = 0;;) {  // that is not done
    const auto end = session.pacer.end();
    session.run_parallel(seats.size() - first, [&](std::size_t i) {
      Seat& seat = *seats[first + i];
      const bool begins = i == 0 || seat.pacer.in_progress() || Pacer::Clock::now() < end;
      if (!seat.done && begins) work_on(seat, first + i, task, end);
    });
    session.pacer.count(frames_of(seats) - counted);
    counted = frames_of(seats);
    while (first < seats.size() && seats[first]->done) ++first;
    if (first == seats.size()) break;
    session.pacer.pause();
  }
  for (const auto& seat : seats) {
    if (seat->failure) std::rethrow_exception(seat->failure);
  }
}

// On any thread; touches nothing but its own seat.
void Machines::work_on(Seat& seat, std::size_t number, const Task& task, Pacer::Clock::time_point end) {
  const auto attempt = [&seat, number, &task] {
    try {
      task(seat, number);
    } catch (const std::exception&) {
      seat.failure = std::current_exception();
    }
  };
  try {
    seat.done = seat.pacer.work(end, attempt);
  } catch (const std::bad_alloc&) {
    seat.failure = std::current_exception();
    seat.done = true;
  }
}

void Machines::append_texts(Session& session) const {
  for (const auto& seat : seats_) {
    (session.out += " |") += seat->text;
    session.pacer.breathe();
  }
}

void Machines::Seat::tell() {
  player->append_view(text);
  over = player->machine().game_over();
}

void Machines::Seat::step(const Action& action, Autoreset autoreset) {
  if (autoreset == Autoreset::kNextStep && over) return player->reset();
  player->act(action);
  if (autoreset != Autoreset::kSameStep || !player->machine().game_over()) return;
  player->view().append_final(text, player->machine());
  const Outcome outcome = player->outcome();
  player->reset();
  player->set_outcome(outcome);
}

}  // namespace racebeam
