#include "protocol/line/action.hpp"

#include <cmath>
#include <string>

#include "games/game/actions.hpp"
#include "protocol/request_error.hpp"
#include "system/similar.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr int kMostTimes = 1'000'000'000;  // Session::check_frames() limits what is asked for in all

// `end`: the numbers that the player may have are below it.
[[noreturn]] void refuse(std::string_view word, std::string_view why, const AllowedActions& actions,
                         int end = kConsoleActions) {
  std::string list;
  std::vector<std::string_view> names;
  for (int action = 0; action < end; ++action) {
    if ((actions.allowed >> action & 1) == 0) continue;
    ((list += ' ') += std::to_string(action) + '=') += action_name(action);
    names.push_back(action_name(action));
  }
  throw RequestError(ErrorCode::kBadAction, quote(word) + std::string(why) + ';' + did_you_mean(word, names) +
                                                ' ' + std::string(actions.game) + " takes" + list);
}

std::string upper_case(std::string_view word) {
  std::string upper(word);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

// `end`: the player's numbers are below it.
int number_of(std::string_view word, const AllowedActions& actions, int end) {
  const bool digits = !word.empty() && word[0] >= '0' && word[0] <= '9';
  auto number = digits ? parse_number<int>(word) : action_number(word);
  if (!number && !digits) number = action_number(upper_case(word));
  if (!number || *number < 0 || *number >= kConsoleActions) refuse(word, " is not an action", actions);
  if (*number >= end) refuse(word, " is an action of player A only", actions, end);
  if ((actions.allowed >> *number & 1) == 0)
    refuse(word,
           is_of_console(*number) ? " needs a game that was loaded with action_set=console"
                                  : " is not in the action set that was loaded",
           actions);
  return *number;
}

float strength_of(std::string_view text) {
  const auto strength = parse_number<float>(text);
  if (strength && std::isfinite(*strength)) return *strength;
  throw RequestError(ErrorCode::kBadValue,
                     "the strength of a paddle is " + quote(text) + "; it takes a finite number");
}

}  // namespace

Action parse_action(std::string_view word, const AllowedActions& actions) {
  Action action;
  std::string_view a = word;
  if (const auto times = cut_behind(a, '*'); a.size() < word.size())
    action.times = static_cast<int>(number_within(times, "how often an action is repeated", 1, kMostTimes));
  const std::size_t players = a.size();
  std::string_view b = cut_behind(a, '/');
  const bool has_b = a.size() < players;
  const auto player = [&actions](std::string_view text, float& strength, int end) {
    const std::size_t whole = text.size();
    const std::string_view part = cut_behind(text, '@');
    strength = text.size() < whole ? strength_of(part) : 1;
    return number_of(text, actions, end);
  };
  action.act.a = player(a, action.act.strength_a, kConsoleActions);
  if (has_b) action.act.b = kActions + player(b, action.act.strength_b, kActions);
  return action;
}

}  // namespace racebeam
