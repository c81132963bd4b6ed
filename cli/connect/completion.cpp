#include "cli/connect/completion.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <racebeam/client/reply.hpp>
#include <utility>

namespace racebeam {
namespace {

using client::detail::split;
using Texts = std::vector<std::string>;

bool begins_alike(std::string_view text, std::string_view begin) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return text.size() >= begin.size() && std::ranges::equal(text.substr(0, begin.size()), begin, same);
}

bool is_upper(std::string_view text) {
  return !text.empty() && std::isupper(static_cast<unsigned char>(text[0])) != 0;
}

// "FIELD|none" of "[FIELD[:ENCODING]...|none]": what may be left out inside, and dots, say how to go on.
std::string plain(std::string_view token) {
  if (token.starts_with('[') && token.ends_with(']')) token = token.substr(1, token.size() - 2);
  std::string text;
  int depth = 0;
  for (const char c : token) {
    depth += c == '[' ? 1 : 0;
    if (depth == 0 && c != '.') text += c;
    depth -= c == ']' ? 1 : 0;
  }
  return text;
}

// The names in a list such as "fields of observe: ram: 128 bytes; lives: remaining lives". `mark` follows a
// name.
Texts names_in(std::string_view text, std::string_view mark) {
  Texts words;
  text.remove_prefix(std::min(text.find(": ") + 2, text.size()));
  while (!text.empty()) {
    const std::string_view entry = text.substr(0, text.find("; "));
    const std::size_t end = std::min(entry.find_first_of(" :"), entry.size());
    if (entry.substr(end).starts_with(mark)) words.emplace_back(entry.substr(0, end));
    text.remove_prefix(std::min(entry.size() + 2, text.size()));
  }
  return words;
}

// Adds `begin` to each word.
Texts after(std::string_view begin, Texts words) {
  for (std::string& word : words) word.insert(0, begin);
  return words;
}

// What of a word is before the last of these signs, and the sign.
std::string_view before_last(std::string_view word, std::string_view signs) {
  const std::size_t at = word.find_last_of(signs);
  return word.substr(0, at == std::string_view::npos ? 0 : at + 1);
}

// "A", "B" and "C" of "A, B or C". None if one of them is more than a word, such as "1 to 50".
Texts words_of_list(std::string_view text) {
  Texts words{""};
  for (const std::string_view word : split(text, ' ')) {
    if (word == "or") {
      words.emplace_back();
    } else if (!words.back().empty()) {
      return {};
    } else {
      words.back() = word.substr(0, word.find(','));
      if (word.ends_with(',')) words.emplace_back();
    }
  }
  return words;
}

constexpr std::array<std::string_view, 4> kTakesStates = {"restore", "drop", "export", "branch"};

}  // namespace

std::vector<std::string> Completion::words(std::string_view before, std::string_view word) const {
  const auto typed = split(before, ' ');
  const auto command = std::ranges::find_if(typed, [](std::string_view one) { return !one.empty(); });
  Texts found;
  if (command == typed.end()) {
    found = own_;
    for (std::string& name : commands()) found.push_back(std::move(name));
  } else {
    found = arguments(*command, word);
  }
  std::erase_if(found, [word](const std::string& one) { return !begins_alike(one, word); });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// help begins with "commands: hello help ...;".
std::vector<std::string> Completion::commands() const {
  const std::string text = ask_("help");
  Texts names;
  for (const std::string_view word : split(std::string_view(text).substr(0, text.find(';')), ' '))
    if (!word.empty() && !word.ends_with(':')) names.emplace_back(word);
  return names;
}

// From the usage, with which `help COMMAND` begins: "save NAME [generator=1] [machine=N]: ...".
std::vector<std::string> Completion::arguments(std::string_view command, std::string_view word) const {
  const Texts names = commands();
  if (std::ranges::find(names, command) == names.end()) return {};
  const std::string text = ask_("help " + std::string(command));
  Texts found;
  auto tokens = split(std::string_view(text).substr(0, text.find(": ")), ' ');
  if (!tokens.empty()) tokens.erase(tokens.begin());
  for (const std::string_view token : tokens) add_alternatives(command, plain(token), word, found);
  return found;
}

void Completion::add_alternatives(std::string_view command, std::string_view token, std::string_view word,
                                  std::vector<std::string>& found) const {
  const std::size_t equals = token.find('=');
  const std::string key(equals == std::string_view::npos ? "" : token.substr(0, equals + 1));
  if (is_upper(key)) {  // KEY=VALUE
    const std::string_view typed = before_last(word, "=");
    for (const std::string& name : named(command, "KEY", word)) found.push_back(name + '=');
    for (std::string& pair : after(typed, values_of(typed.substr(0, typed.find('=')))))
      found.push_back(std::move(pair));
    return;
  }
  for (const std::string_view one : split(token.substr(key.size()), '|')) {
    const bool free = is_upper(one);
    if (!key.empty()) {
      found.push_back(free ? key : key + std::string(one));
    } else if (free) {
      for (std::string& name : named(command, one, word)) found.push_back(std::move(name));
    } else if (!one.empty()) {
      found.emplace_back(one);
    }
  }
}

// What may stand for a name in capital letters.
std::vector<std::string> Completion::named(std::string_view command, std::string_view placeholder,
                                           std::string_view word) const {
  if (placeholder == "GAME") return listed(command == "games" ? "games all" : "games", "games");
  if (placeholder == "COMMAND") return commands();
  if (placeholder == "KEY") return names_in(ask_("help settings"), " (");
  if (placeholder == "A" || placeholder == "ACTION") {
    Texts names = listed("actions", "actions");
    for (std::string& pair : names) pair.erase(0, pair.find(':') + 1);
    return after(before_last(word, "/,"), std::move(names));
  }
  if (placeholder == "FIELD") {
    const std::string_view field = before_last(word, ":");
    return field.empty() ? names_in(ask_("help fields"), ":") : after(field, listed("hello", "encodings"));
  }
  if (placeholder != "NAME") return {};
  if (std::ranges::find(kTakesStates, command) != kTakesStates.end()) return listed("states", "states");
  if (command != "watch") return {};
  Texts names;
  for (const client::Group& group : client::Reply("ok " + ask_("shared"), [](auto&, auto) {}).rest())
    if (group.has("name")) names.push_back(group.text("name"));
  return names;
}

// Returns the values of a setting. help has them in brackets: "life_loss (ignored, reported, end or restart):
// ...".
std::vector<std::string> Completion::values_of(std::string_view key) const {
  if (key.empty()) return {};
  if (key == "preset") return listed("hello", "presets");
  const std::string text = ask_("help " + std::string(key)), head = std::string(key) + " (";
  const std::size_t begin = text.find(head);
  if (begin == text.npos) return {};
  return words_of_list(
      std::string_view(text).substr(begin + head.size(), text.find(')', begin) - begin - head.size()));
}

// The words of a value that are separated by commas.
std::vector<std::string> Completion::listed(const std::string& request, std::string_view key) const {
  const client::Reply reply("ok " + ask_(request), [](auto&, auto) {});
  return reply.first().has(key) ? reply.first().list(key) : Texts{};
}

}  // namespace racebeam
