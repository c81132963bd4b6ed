#include "protocol/line/commands/help.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "environment/settings/play_settings.hpp"
#include "protocol/description/tables.hpp"
#include "protocol/encoding/encoding.hpp"
#include "protocol/line/commands/command_table.hpp"
#include "protocol/line/field.hpp"
#include "protocol/line/old_words.hpp"
#include "protocol/request_error.hpp"
#include "system/folded.hpp"
#include "system/named_rows.hpp"
#include "system/similar.hpp"

namespace racebeam {
namespace {

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

std::string list_of(Words names) {
  std::string list;
  for (const std::string_view name : names) (list += list.empty() ? "" : " ") += name;
  return list;
}

// protocol/PROTOCOL.md has the same tables, with marked words.
std::string plain(std::string text) {
  std::erase(text, '`');
  return text;
}

std::string about(const Command& command) { return joined({usage(command), ": ", command.summary}); }
std::string about(const SettingRow& row) {
  return plain(joined({row.name, " (", row.accepted, "): ", row.summary}));
}
std::string about(const PresetRow& row) { return joined({row.name, " (", row.source, ") sets ", row.words}); }
std::string about(const FieldRow& row) { return plain(joined({row.name, ": ", row.summary})); }
std::string about(const EncodingRow& row) { return joined({row.name, ": ", row.summary}); }
std::string about(const description::Choice& row) {
  return plain(joined({row.key, "=", row.value, ": ", row.meaning}));
}
std::string about(const ErrorRow& row) { return plain(joined({row.name, ": ", row.meaning})); }

template <typename Rows>
HelpText table(std::string_view head, const Rows& rows) {
  HelpText text{std::string(head), {}};
  for (const auto& row : rows) text.entries.push_back(about(row));
  return text;
}

HelpText on_settings() { return table("settings of load, as KEY=VALUE:", setting_rows()); }

HelpText on_presets() { return table("presets of load, as preset=NAME:", preset_rows()); }

HelpText on_fields() {
  HelpText text = table("fields of observe and look:", field_rows());
  text.entries.push_back("those that are bytes are written as FIELD:ENCODING: " +
                         list_of(names_of(encodings())));
  return text;
}

HelpText on_encodings() {
  HelpText text = table("encodings of fields that are bytes, as in observe screen:delta:", encodings());
  std::string default_text = "without one:";
  for (const FieldRow& row : field_rows()) {
    if (!row.number) default_text += joined({" ", row.name, ":", word_for(kEncodingNames, row.usual)});
  }
  text.entries.push_back(std::move(default_text));
  return text;
}

HelpText on_errors() { return table("codes of errors, for programs:", codes()); }

HelpText on_states() {
  HelpText text{"states, places in a game to return to:", {}};
  for (const std::string_view name : {"save", "restore", "drop", "states", "export", "import", "branch"})
    text.entries.push_back(about(find_command(name)));
  text.entries.emplace_back("a NAME has 1 to 64 letters, digits, - and _; load forgets all states");
  return text;
}

constexpr std::array kTopics = {HelpTopic{"settings", on_settings}, HelpTopic{"presets", on_presets},
                                HelpTopic{"fields", on_fields},     HelpTopic{"encodings", on_encodings},
                                HelpTopic{"errors", on_errors},     HelpTopic{"states", on_states}};

HelpText on(const Command& command) {
  HelpText text{about(command), {}};
  if (!command.hint.empty()) text.entries.emplace_back(command.hint);
  if (!command.example.empty()) text.entries.push_back(joined({"example: ", command.example}));
  return text;
}

// The text of the row of that name, with the kind of table.
template <typename Rows>
bool find_in(const Rows& rows, std::string_view name, std::string_view kind, HelpText& text) {
  const auto found = std::ranges::find_if(rows, [name](const auto& row) { return row.name == name; });
  if (found == rows.end()) return false;
  text = {std::string(kind), {about(*found)}};
  return true;
}

// Whether `name` is a word of the command's arguments: a key, or one of its values.
bool takes(const Command& command, std::string_view name) {
  constexpr std::string_view kOfWords = "abcdefghijklmnopqrstuvwxyz0123456789-_";
  std::string_view rest = command.arguments;
  for (std::size_t begin; (begin = rest.find_first_of(kOfWords)) != std::string_view::npos;) {
    rest.remove_prefix(begin);
    const std::size_t size = std::min(rest.find_first_not_of(kOfWords), rest.size());
    if (rest.substr(0, size) == name) return true;
    rest.remove_prefix(size);
  }
  return false;
}

// Adds the commands of whose arguments `name` is a word. Returns whether there are any.
bool add_commands(std::string_view name, HelpText& text) {
  const std::size_t before = text.entries.size();
  for (const Command& command : commands())
    if (takes(command, name)) text.entries.push_back(about(command));
  return text.entries.size() > before;
}

// Adds the values that a key of a command may have, or the value of that name.
void add_choices(std::string_view name, HelpText& text) {
  for (const description::Choice& choice : description::kChoices)
    if (choice.key == name || choice.value == name) text.entries.push_back(about(choice));
}

// Adds the old words that are `name`, or a pair with that key. Returns whether there are any.
bool add_old(std::string_view name, HelpText& text) {
  const std::size_t before = text.entries.size();
  const std::string_view mark = before == 0 ? "" : "old: ";
  for (const OldWord& row : description::kOldWords) {
    if (row.old.substr(0, row.old.find('=')) == name || &row == old_field(name))
      text.entries.push_back(joined({mark, deprecation_of(row)}));
  }
  return text.entries.size() > before;
}

template <typename... Rows>
[[noreturn]] void refuse(std::string_view name, const Rows&... rows) {
  std::vector<std::string_view> all_names;
  const auto add = [&all_names](const auto& names) {
    all_names.insert(all_names.end(), names.begin(), names.end());
  };
  (add(names_of(rows)), ...);
  throw RequestError(
      ErrorCode::kBadArguments,
      "unknown word " + quote(name) + ';' + did_you_mean(name, all_names) + " help without a word lists all");
}

constexpr int kNarrowest = 20;
constexpr std::size_t kIndent = 2, kHanging = 6;

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

HelpText help() {
  return {"commands: " + list_of(names_of(commands())),
          {"help COMMAND explains one", "more with help " + list_of(names_of(kTopics)),
           "help NAME explains a setting, field, preset, encoding or error code"}};
}

HelpText help_on(std::string_view name) {
  const auto topic = std::ranges::find(kTopics, name, &HelpTopic::name);
  if (topic != kTopics.end()) return topic->text();
  const auto has_name = [name](const auto& row) { return row.name == name; };
  if (std::ranges::any_of(commands(), has_name) || std::ranges::any_of(aliases(), has_name))
    return on(find_command(name));
  HelpText text{"a word of:", {}};
  const bool found =
      find_in(setting_rows(), name, "a setting of load, as KEY=VALUE:", text) ||
      find_in(field_rows(), row_of_field(name), "a field of observe and look:", text) ||
      find_in(preset_rows(), name, "a preset of load, as preset=NAME:", text) ||
      find_in(encodings(), name, "an encoding of fields that are bytes, as FIELD:ENCODING:", text) ||
      find_in(codes(), name, "the code of an error:", text);
  const bool is_command = add_commands(name, text);
  add_choices(name, text);
  if (text.entries.empty()) text.head = "an old word:";
  if (add_old(name, text) || is_command || found) return text;
  refuse(name, kTopics, commands(), setting_rows(), field_rows(), preset_rows(), encodings(), codes());
}

void append_help(std::string& out, const HelpText& help, int columns) {
  if (columns <= 0) {
    out += help.head;
    bool listed = help.head.ends_with(':');
    for (const std::string& entry : help.entries) (out += std::exchange(listed, false) ? " " : "; ") += entry;
    return;
  }
  const auto width = static_cast<std::size_t>(std::max(columns, kNarrowest));
  append_folded(out, help.head, width, 3, kHanging);
  for (const std::string& entry : help.entries) {
    (out += '\n').append(kIndent, ' ');
    append_folded(out, entry, width, kIndent, kHanging);
  }
}

}  // namespace racebeam
