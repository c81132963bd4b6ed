// Many machines in one session: `open`, `step`, `restart`. They run on the server's threads.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "environment/vector/autoreset.hpp"
#include "protocol/line/player.hpp"

namespace racebeam {

class Session;

std::span<const std::string_view> autoresets();  // their names, as Autoreset counts
std::string_view name_of(Autoreset autoreset);

class Machines {
 public:
  bool empty() const { return seats_.empty(); }
  std::size_t size() const { return seats_.size(); }
  Player& player(std::size_t number) { return *seats_[number]->player; }
  Autoreset autoreset() const { return autoreset_; }
  void close() { seats_.clear(); }
  void observe(Session& session, const std::vector<Field>& fields);  // throws Refusal, and changes nothing
  void rest();                                                       // gives back memory that only saves time
  std::size_t footprint(const std::vector<Field>& fields) const;     // bytes of memory, about

  // Throws Refusal when replies about so many, of these fields, are longer than they may be.
  // So many machines with these fields. Throws Refusal when replies about them are longer than they may be,
  // or when there is no memory for the machines. Returns how many bytes a reply may have.
  static std::size_t check(Session& session, const std::vector<Field>& fields, std::size_t count,
                           Autoreset autoreset);

  // Each appends its reply to session.out. All throw Refusal; `open` then leaves the machines that were
  // there.
  void open(Session& session, std::size_t count, Autoreset autoreset);
  void step(Session& session, std::span<const Action> actions);          // one each
  void restart(Session& session, std::span<const std::uint8_t> chosen);  // those that are not 0

 private:
  struct Seat {
    Pacer pacer;
    std::unique_ptr<Player> player;
    bool over = false;           // its episode
    bool done = false;           // with the request
    std::string text;            // its part of the reply; kept for its memory
    std::exception_ptr failure;  // of the request

    void tell();  // what the machine shows
    void step(const Action& action, Autoreset autoreset);
  };
  using Seats = std::vector<std::unique_ptr<Seat>>;
  using Task = std::function<void(Seat& seat, std::size_t number)>;

  static std::int64_t frames_of(const Seats& seats);
  static void work_on_all(Session& session, Seats& seats, const Task& task);
  static void work_on(Seat& seat, std::size_t number, const Task& task, Pacer::Clock::time_point end);
  void check_frames(const Session& session, std::int64_t acts, std::span<const std::uint8_t> resets) const;
  void append_texts(Session& session) const;

  Seats seats_;
  Autoreset autoreset_ = Autoreset::kNextStep;
  std::size_t reply_bytes_ = 0;  // that a reply may have
};

}  // namespace racebeam
