#include "protocol/line/command.hpp"

#include <algorithm>

#include "protocol/line/context.hpp"
#include "protocol/request_error.hpp"
#include "system/named_rows.hpp"

namespace racebeam {
namespace {

// "no arguments", "1 argument", "at least 1 argument", "1 to 3 arguments"
std::string count_text(const Command& command) {
  const std::string least = std::to_string(command.least);
  const std::string one = command.least == 1 ? " argument" : " arguments";
  if (command.most == 0) return "no arguments";
  if (command.most == command.least) return least + one;
  if (command.most == kAnyNumber) return "at least " + least + one;
  return least + " to " + std::to_string(command.most) + " arguments";
}

}  // namespace

std::string usage(const Command& command) {
  std::string text(command.name);
  if (!command.arguments.empty()) (text += ' ') += command.arguments;
  return text;
}

const Command* CommandTable::look_up(std::string_view name) const {
  const auto found = std::ranges::find(commands, name, &Command::name);
  if (found != commands.end()) return &*found;
  const auto alias = std::ranges::find(aliases, name, &Alias::name);
  return alias != aliases.end() ? look_up(alias->command) : nullptr;
}

const Command& CommandTable::find(std::string_view name) const {
  if (const Command* const found = look_up(name)) return *found;
  throw RequestError(ErrorCode::kUnknownCommand, unknown_name("command", name, names_of(commands)));
}

void refuse_without_token(std::string_view name) {
  throw RequestError(ErrorCode::kUnauthorized,
                     "this server requires a token before " + quote(name) + "; send hello token=TOKEN first");
}

void check(const Command& command, const Context& context, std::size_t arguments) {
  const std::string name(command.name);
  if (command.needs >= Needs::kAdmission && !context.peer.admitted) refuse_without_token(name);
  if (arguments < command.least || arguments > command.most) {
    throw RequestError(ErrorCode::kBadArguments, name + " takes " + count_text(command) + ", not " +
                                                     std::to_string(arguments) + ": " + usage(command));
  }
  if (command.needs >= Needs::kGame && !context.game.loaded)
    throw RequestError(ErrorCode::kNoGame, name + " needs a game; load one first");
  if (command.needs == Needs::kMachines && context.machines.empty())
    throw RequestError(ErrorCode::kNoMachines, name + " needs machines; open some first");
}

}  // namespace racebeam
