#include "agents/experiment/agent_file.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <sstream>
#include <string_view>
#include <vector>

#include "environment/settings/setting_tables.hpp"
#include "games/files/toml_section.hpp"
#include "recording/phrase_seed.hpp"
#include "recording/submission_folder.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 16;
constexpr std::size_t kMaxLetters = 4000;  // of a text
constexpr std::array<std::string_view, 8> kKeys = {"agent", "version", "preset", "training_frames",
                                                   "words", "link",    "role",   "phrase"};
constexpr std::size_t kRequired = 4;  // keys, the first ones

std::vector<std::string_view> presets() {
  std::vector<std::string_view> names;
  for (const description::EvaluationPreset& preset : description::kEvaluationPresets)
    names.push_back(preset.name);
  names.emplace_back("other");
  return names;
}

// The value as errors show it.
std::string text_of(const toml::node& value) {
  if (const auto text = value.value_exact<std::string>()) return quote(*text);
  if (value.is_array()) return "a list";
  if (value.is_table()) return "a table";
  if (const auto flag = value.value_exact<bool>()) return *flag ? "true" : "false";
  if (const auto number = value.value_exact<std::int64_t>()) return std::to_string(*number);
  if (!value.is_floating_point()) return "a date or a time";
  std::ostringstream text;
  text << *value.as_floating_point();
  return text.str();
}

std::size_t letters_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0U) != 0x80; }));
}

bool is_agent_name(std::string_view text) { return is_plain_name(text, kMaxAgentName); }

bool is_link(std::string_view text) {
  const std::size_t begin = text.starts_with("https://") ? 8 : text.starts_with("http://") ? 7 : 0;
  return text.empty() ||
         (begin != 0 && text.size() > begin && text.find_first_of(" \t\n\v\f\r") == text.npos);
}

// Checks the keys of one file.
class AgentTable {
 public:
  AgentTable(const std::string& path, const toml::table& table) : path_(path), table_(table) {}

  void check_keys() const {
    for (const auto& [key, value] : table_)
      if (std::ranges::find(kKeys, key.str()) == kKeys.end())
        throw InvalidInput(path_ + ": unknown key " + quote(key.str()) + "; accepted: " + join(kKeys, ", "));
    const std::vector<std::string_view> required(kKeys.begin(), kKeys.begin() + kRequired);
    for (const std::string_view key : required)
      if (table_.get(key) == nullptr)
        throw InvalidInput(path_ + " lacks the key " + quote(key) + "; expected " + join(required, ", "));
  }

  // The text of a key; nothing: the file lacks it.
  std::optional<std::string> text(std::string_view key, std::size_t least, std::size_t most) const {
    const toml::node* const value = table_.get(key);
    if (value == nullptr) return std::nullopt;
    std::optional<std::string> text = value->value_exact<std::string>();
    if (!text) refuse(key, "a text");
    const std::size_t letters = letters_of(*text);
    const std::string range =
        (least == 0 ? "at most " : std::to_string(least) + " to ") + std::to_string(most);
    if (letters < least || letters > most)
      throw InvalidInput(path_ + ": " + std::string(key) + " has " + std::to_string(letters) +
                         " letters; expected " + range);
    return text;
  }

  std::optional<std::string> text(std::string_view key, const std::function<bool(std::string_view)>& is_good,
                                  const std::string& expected) const {
    std::optional<std::string> text = this->text(key, 0, kMaxLetters);
    if (text && !is_good(*text)) refuse(key, expected);
    return text;
  }

  std::optional<std::string> choice(std::string_view key, const std::vector<std::string_view>& words) const {
    const auto is_word = [&](std::string_view text) { return std::ranges::find(words, text) != words.end(); };
    return text(key, is_word, join(words, ", "));
  }

  void check_number(std::string_view key, std::int64_t most) const {
    const std::optional<std::int64_t> number = table_.get(key)->value_exact<std::int64_t>();
    if (!number || *number < 0 || *number > most)
      refuse(key, "a whole number from 0 to " + std::to_string(most));
  }

 private:
  [[noreturn]] void refuse(std::string_view key, const std::string& expected) const {
    throw InvalidInput(path_ + ": " + std::string(key) + " is " + text_of(*table_.get(key)) + "; expected " +
                       expected);
  }

  const std::string& path_;
  const toml::table& table_;
};

}  // namespace

AgentFile read_agent_file(const std::string& path) {
  const std::string text = read_input_file("description of the agent", path, kMaxBytes);
  const TomlSource source{text, path};
  const toml::table table = parse_toml(source);
  const AgentTable file(path, table);
  file.check_keys();
  AgentFile found;
  found.agent = file.text("agent", is_agent_name, plain_name_rule(kMaxAgentName)).value();
  file.text("version", 1, kMaxAgentName);
  found.preset = file.choice("preset", presets()).value();
  file.check_number("training_frames", kMaxTrainingFrames);
  file.text("words", 0, kMaxLetters);
  file.text("link", is_link, "https://... or http://...");
  file.choice("role", {kAgentRoles.begin(), kAgentRoles.end()});
  found.phrase = file.text("phrase", is_phrase, std::string(kPhraseRule));
  return found;
}

}  // namespace racebeam
