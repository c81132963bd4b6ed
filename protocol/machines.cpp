#include "protocol/machines.hpp"

#include <algorithm>
#include <array>

#include "protocol/session.hpp"

namespace racebeam {
namespace {

constexpr std::array<std::string_view, 3> kAutoresets = {"next-step", "same-step", "disabled"};
constexpr int kResetFrames = 70;  // about what a reset costs

}  // namespace

std::optional<Autoreset> autoreset_of(std::string_view name) {
  const auto found = std::ranges::find(kAutoresets, name);
  if (found == kAutoresets.end()) return std::nullopt;
  return static_cast<Autoreset>(found - kAutoresets.begin());
}

std::string_view name_of(Autoreset autoreset) { return kAutoresets[static_cast<std::size_t>(autoreset)]; }

void MachinesWork::observe(const std::vector<Field>& fields) {
  for (Seat& seat : seats_) seat.player->observe(fields);
}

void MachinesWork::rest() {
  for (Seat& seat : seats_)
    if (seat.player) seat.player->machine().rest();
}

void MachinesWork::check_replies(const Session& session, const std::vector<Field>& fields, std::size_t count,
                                 Autoreset autoreset) {
  const std::size_t once = text_size(fields, session.player->machine());
  const std::size_t each = autoreset == Autoreset::kSameStep ? 2 * once : once;
  session.check_reply(count * each, std::to_string(count) + " machines with these fields");
}

void MachinesWork::open(std::size_t count, Autoreset autoreset, std::unique_ptr<Player> first) {
  seats_.clear();
  seats_.resize(count);
  seats_[0].player = std::move(first);
  autoreset_ = autoreset;
  job_ = Job::kOpen;
  next_ = 0;
}

void MachinesWork::step(std::vector<Action>& actions) {
  actions_.swap(actions);
  job_ = Job::kStep;
  next_ = 0;
}

void MachinesWork::restart(std::vector<std::uint8_t>& chosen) {
  chosen_.swap(chosen);
  job_ = Job::kRestart;
  next_ = 0;
}

bool MachinesWork::go_on(Session& session, int& frames) {
  const Settings& machine = session.settings.machine;
  const int cost =
      job_ == Job::kStep ? std::max(machine.frame_skip, machine.frame_skip_max) : 2 * kResetFrames;
  while (next_ < seats_.size()) {
    if (frames <= 0) return false;
    const std::size_t affordable = std::max(static_cast<std::size_t>(frames / cost), session.service.threads);
    const std::size_t first = next_, count = std::min(affordable, seats_.size() - first);
    const auto task = [this, &session, first](std::size_t number) { work_on(session, first + number); };
    if (session.service.parallel) {
      session.service.parallel(count, std::ref(task));
    } else {
      for (std::size_t number = 0; number < count; ++number) task(number);
    }
    next_ += count;
    frames -= static_cast<int>(count) * cost;
  }
  reply(session);
  return true;
}

// On any thread; touches nothing but its own seat.
void MachinesWork::work_on(const Session& session, std::size_t number) {
  Seat& seat = seats_[number];
  seat.text.clear();
  seat.failure.clear();
  try {
    if (job_ == Job::kOpen) open_one(session, number);
    seat.player->begin_request();
    if (job_ == Job::kStep) step_one(seat, actions_[number]);
    if (job_ == Job::kRestart && chosen_[number] != 0) seat.player->reset();
    seat.player->append_view(seat.text);
    seat.over = seat.player->machine().game_over();
  } catch (const std::exception& error) {
    seat.failure = error.what();
  }
}

void MachinesWork::open_one(const Session& session, std::size_t number) {
  if (seats_[number].player) return;
  PlaySettings settings = session.settings;
  settings.machine.random_seed += static_cast<std::uint32_t>(number);
  seats_[number].player = std::make_unique<Player>(session.cartridge, settings, session.fields);
}

void MachinesWork::step_one(Seat& seat, const Action& action) {
  Player& player = *seat.player;
  if (autoreset_ == Autoreset::kNextStep && seat.over) return player.reset();
  player.act(action);
  if (autoreset_ != Autoreset::kSameStep || !player.machine().game_over()) return;
  player.view().append_final(seat.text, player.machine());
  const Outcome outcome = player.outcome();
  player.reset();
  player.set_outcome(outcome);
}

void MachinesWork::reply(Session& session) {
  for (const Seat& seat : seats_) {
    if (!seat.failure.empty()) throw std::runtime_error(seat.failure);
  }
  session.out += "ok";
  append_pair(session.out, "machines", static_cast<std::int64_t>(seats_.size()));
  if (job_ == Job::kOpen) append_pair(session.out, "autoreset", name_of(autoreset_));
  for (const Seat& seat : seats_) {
    (session.out += " |") += seat.text;
    if (job_ == Job::kStep) session.count(seat.player->outcome());
  }
}

// Machines of which some were not made are of no use.
void MachinesWork::give_up(Session&) {
  if (job_ == Job::kOpen) seats_.clear();
}

}  // namespace racebeam
