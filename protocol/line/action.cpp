#include "protocol/line/action.hpp"

#include <cmath>
#include <string>

#include "games/game/actions.hpp"
#include "protocol/request_error.hpp"
#include "system/similar.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr int kMaxTimes = 1'000'000'000;  // Context::check_frames() limits the acts of a request

enum class Player : bool { kA, kB };

bool is_allowed(int action, const AllowedActions& actions, Player player) {
  return (player == Player::kA ? actions.allowed : actions.allowed_b)[static_cast<std::size_t>(action)];
}

[[noreturn]] void refuse(std::string_view word, std::string_view why, const AllowedActions& actions,
                         Player player = Player::kA) {
  std::string list;
  std::vector<std::string_view> names;
  for (int action = 0; action < kActionNumbers; ++action) {
    if (!is_allowed(action, actions, player)) continue;
    ((list += ' ') += std::to_string(action) + '=') += action_name(action);
    names.push_back(action_name(action));
  }
  throw RequestError(ErrorCode::kBadAction, quote(word) + std::string(why) + ';' + did_you_mean(word, names) +
                                                ' ' + std::string(actions.game) + " takes" + list);
}

std::string_view why_not(int action) {
  if (is_of_console(action)) return " needs a game that was loaded with action_set=console";
  if (is_key(action)) return " needs a game with a keyboard, loaded with action_set=console";
  if (has_more_buttons(action)) return " needs a controller with that button, and action_set=console";
  return " is not in the action set that was loaded";
}

int number_of(std::string_view word, const AllowedActions& actions, Player player) {
  const bool digits = !word.empty() && word[0] >= '0' && word[0] <= '9';
  auto number = digits ? parse_number<int>(word) : action_number(word);
  if (!number && !digits) number = action_number(upper_case(word));
  if (!number || !is_action(*number)) refuse(word, " is not an action", actions);
  const bool is_of_controller = *number >= kConsoleActions;
  if (digits && is_of_controller && !is_allowed(*number, actions, player))
    refuse(word, " is not an action", actions, player);
  if (player == Player::kB && is_of_console(*number))
    refuse(word, " is an action of player A only", actions, player);
  if (!is_allowed(*number, actions, player)) refuse(word, why_not(*number), actions, player);
  return *number;
}

// A place on the screen, "80,100", has the number x + 256 * y.
constexpr float kPlaceStep = 256;
constexpr int kMaxPlace = 255;

float strength_of(std::string_view text) {
  const std::size_t whole = text.size();
  std::string_view x = text;
  const std::string_view y = cut_behind(x, ',');
  if (x.size() < whole)
    return static_cast<float>(number_within(x, "the x of a place", 0, kScreenWidth - 1)) +
           kPlaceStep * static_cast<float>(number_within(y, "the y of a place", 1, kMaxPlace));
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
    action.times = static_cast<int>(number_within(times, "how often an action is repeated", 1, kMaxTimes));
  const std::size_t players = a.size();
  std::string_view b = cut_behind(a, '/');
  const bool has_b = a.size() < players;
  const auto player = [&actions](std::string_view text, float& strength, Player who) {
    const std::size_t whole = text.size();
    const std::string_view part = cut_behind(text, '@');
    strength = text.size() < whole ? strength_of(part) : 1;
    return number_of(text, actions, who);
  };
  action.act.a = player(a, action.act.strength_a, Player::kA);
  if (has_b) action.act.b = kActions + player(b, action.act.strength_b, Player::kB);
  return action;
}

}  // namespace racebeam
