// Many machines in one session: `open`, `step`, `restart`. They run on the server's threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "environment/autoreset.hpp"
#include "protocol/player.hpp"
#include "protocol/work.hpp"

namespace racebeam {

std::optional<Autoreset> autoreset_of(std::string_view name);
std::string_view name_of(Autoreset autoreset);

class MachinesWork final : public Work {
 public:
  bool empty() const { return seats_.empty(); }
  std::size_t size() const { return seats_.size(); }
  Autoreset autoreset() const { return autoreset_; }
  void close() { seats_.clear(); }
  void observe(const std::vector<Field>& fields);
  void rest();
  // Throws Refusal when replies about so many, of these fields, are longer than they may be.
  static void check_replies(const Session& session, const std::vector<Field>& fields, std::size_t count,
                            Autoreset autoreset);

  // Each says what go_on() is to do with all machines.
  void open(std::size_t count, Autoreset autoreset, std::unique_ptr<Player> first);
  void step(std::vector<Action>& actions);          // one each; swapped in
  void restart(std::vector<std::uint8_t>& chosen);  // not 0: this one; swapped in

  bool go_on(Session& session, int& frames) override;
  void give_up(Session& session) override;

 private:
  enum class Job { kOpen, kStep, kRestart };

  struct Seat {
    std::unique_ptr<Player> player;
    bool over = false;    // its episode
    std::string text;     // its part of the reply; kept for its memory
    std::string failure;  // of the job
  };

  void work_on(const Session& session, std::size_t number);
  void open_one(const Session& session, std::size_t number);
  void step_one(Seat& seat, const Action& action);
  void reply(Session& session);

  std::vector<Seat> seats_;
  Autoreset autoreset_ = Autoreset::kNextStep;
  Job job_ = Job::kOpen;
  std::vector<Action> actions_;
  std::vector<std::uint8_t> chosen_;
  std::size_t next_ = 0;  // seats before it are done
};

}  // namespace racebeam
