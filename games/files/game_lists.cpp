#include "games/files/game_lists.hpp"

#include <algorithm>
#include <charconv>

#include "games/game/actions.hpp"

namespace racebeam {
namespace {

constexpr int kMaxRepeat = 100000;

// A number in decimal digits, such as "12"; nothing for any other text.
std::optional<int> whole_number(std::string_view text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool all = error == std::errc() && end == text.data() + text.size();
  return all && value >= 0 ? std::optional(value) : std::nullopt;
}

int player_action(const Section& section, std::string_view key, const toml::node& node) {
  const std::optional<int> action = action_number(node.value_exact<std::string>().value_or(""));
  if (!action || *action >= kActions)
    section.refuse(node, key, "must be names of actions, such as \"UPFIRE\"");
  return *action;
}

// "FIRE" or "NOOP 60"
void add_actions(const Section& section, std::string_view key, const toml::node& node,
                 std::vector<int>& actions) {
  const std::string text = node.value_exact<std::string>().value_or("");
  const std::size_t space = std::min(text.find(' '), text.size());
  const std::optional<int> action = action_number(std::string_view(text).substr(0, space));
  const std::optional<int> count =
      space == text.size() ? 1 : whole_number(std::string_view(text).substr(space + 1));
  if (!action || *action > kResetAction || !count || *count < 1 || *count > kMaxRepeat)
    section.refuse(node, key, "must be actions, \"NAME\" or \"NAME COUNT\", such as \"NOOP 60\"");
  if (actions.size() + static_cast<std::size_t>(*count) > kMaxRepeat)
    section.refuse(node, key, "must be " + std::to_string(kMaxRepeat) + " actions at most, in all");
  actions.insert(actions.end(), static_cast<std::size_t>(*count), *action);
}

// 4, or "0-7"
void add_numbers(const Section& section, std::string_view key, const toml::node& node, int largest,
                 std::vector<int>& numbers) {
  const std::optional<std::int64_t> number = node.value_exact<std::int64_t>();
  const std::string text = number ? std::to_string(*number) : node.value_exact<std::string>().value_or("");
  const std::size_t dash = std::min(text.find('-'), text.size());
  const std::optional<int> first = whole_number(text.substr(0, dash));
  const std::optional<int> last = dash == text.size() ? first : whole_number(text.substr(dash + 1));
  if (!first || !last || *last < *first || *last > largest)
    section.refuse(node, key,
                   "must be numbers from 0 to " + std::to_string(largest) + ", or ranges such as \"0-7\"");
  for (int n = *first; n <= *last; ++n) {
    if (std::find(numbers.begin(), numbers.end(), n) != numbers.end())
      section.refuse(node, key, std::to_string(n) + " is listed twice");
    numbers.push_back(n);
  }
}

}  // namespace

std::vector<int> read_actions(const Section& section, std::string_view key, std::vector<int> otherwise) {
  const toml::array* list = section.list(key);
  if (!list) return otherwise;
  std::vector<int> actions;
  for (const toml::node& node : *list) actions.push_back(player_action(section, key, node));
  std::sort(actions.begin(), actions.end());
  const auto twice = std::adjacent_find(actions.begin(), actions.end());
  if (twice != actions.end())
    section.refuse(*list, key, std::string(action_name(*twice)) + " is listed twice");
  if (actions.empty()) section.refuse(*list, key, "must not be empty");
  return actions;
}

std::vector<int> read_starting_actions(const Section& section, std::string_view key) {
  std::vector<int> actions;
  if (const toml::array* list = section.list(key))
    for (const toml::node& node : *list) add_actions(section, key, node, actions);
  return actions;
}

std::vector<int> read_numbers(const Section& section, std::string_view key, int largest) {
  const toml::array* list = section.list(key);
  if (!list) return {0};
  std::vector<int> numbers;
  for (const toml::node& node : *list) add_numbers(section, key, node, largest, numbers);
  if (numbers.empty()) section.refuse(*list, key, "must not be empty");
  return numbers;
}

}  // namespace racebeam
