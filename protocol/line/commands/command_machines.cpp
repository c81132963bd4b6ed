// open, step, restart, close
#include <limits>

#include "protocol/line/commands/command_table.hpp"
#include "protocol/line/session.hpp"

namespace racebeam {
namespace {

Autoreset read_autoreset(Words words) {
  if (words.empty()) return Autoreset::kNextStep;
  const auto value = value_of(words[0], "autoreset", "open");
  return static_cast<Autoreset>(choice_of(value, "autoreset", autoresets()));
}

std::size_t read_machines(const Session& session, std::string_view word) {
  const auto count = number_within(word, "N", 1, std::numeric_limits<std::int64_t>::max());
  const int most = session.service.limits.machines;
  if (count <= most) return static_cast<std::size_t>(count);
  throw Refusal(Code::kLimit, "N is " + quote(word) + "; there may be " + std::to_string(most) + " machines");
}

[[noreturn]] void refuse_count(const Session& session, std::size_t given, const std::string& what) {
  throw Refusal(Code::kBadArguments, "there are " + std::to_string(session.machines.size()) +
                                         " machines, but " + std::to_string(given) + " " + what);
}

std::vector<std::uint8_t> read_mask(const Session& session, Words words) {
  if (words.empty()) return std::vector<std::uint8_t>(session.machines.size(), 1);
  const std::string_view mask = words[0];
  if (mask.find_first_not_of("01") != std::string_view::npos)
    throw Refusal(Code::kBadValue, quote(mask) + " is no mask; it takes a 0 or a 1 for each machine");
  if (mask.size() != session.machines.size()) refuse_count(session, mask.size(), "digits in the mask");
  std::vector<std::uint8_t> chosen;
  for (const char digit : mask) chosen.push_back(digit == '1');
  return chosen;
}

}  // namespace

void run_open(Session& session, Words arguments) {
  const std::size_t machines = read_machines(session, arguments[0]);
  const Autoreset autoreset = read_autoreset(arguments.subspan(1));
  session.machines.open(session, machines, autoreset);
}

void run_step(Session& session, Words arguments) {
  const AllowedActions allowed = session.player->allowed();
  const std::size_t machines = session.machines.size();
  if (arguments.size() != 1 && arguments.size() != machines)
    refuse_count(session, arguments.size(), "actions; give one each, or one for all");
  auto& actions = session.actions;
  actions.clear();
  for (const std::string_view word : arguments) {
    actions.push_back(parse_action(word, allowed));
    if (actions.back().times > 1)
      throw Refusal(Code::kBadValue, "a step is one act; *TIMES is for act and branch");
  }
  actions.resize(machines, actions[0]);
  session.machines.step(session, actions);
}

void run_restart(Session& session, Words arguments) {
  session.machines.restart(session, read_mask(session, arguments));
}

void run_close(Session& session, Words) {
  session.stop_recording_machines();
  session.machines.close();
  session.out += "ok";
}

}  // namespace racebeam
