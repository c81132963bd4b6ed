#include "games/files/toml_section.hpp"

#include <algorithm>

#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

int line_of(const toml::source_region& region) { return static_cast<int>(region.begin.line); }

}  // namespace

void TomlSource::refuse(int line, const std::string& field, const std::string& sentence) const {
  throw InvalidInput(file + ":" + std::to_string(line) + ": " + field + ": " + sentence);
}

toml::table parse_toml(const TomlSource& source) {
  try {
    return toml::parse(source.text, source.file);
  } catch (const toml::parse_error& error) {
    source.refuse(line_of(error.source()), "TOML", std::string(error.description()));
  }
}

Section::Section(const TomlSource& source, const toml::table& table, std::string path,
                 const toml::table* base)
    : source_(source), table_(table), path_(std::move(path)), base_(base) {}

const toml::node* Section::node(std::string_view key) const {
  const toml::node* const own = table_.get(key);
  return own || !base_ ? own : base_->get(key);
}

void Section::allow(std::span<const std::string_view> keys) const {
  for (const auto& [key, node] : table_)
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
      source_.refuse(line_of(key.source()), field(key.str()),
                     "unknown key; accepted: " + join(keys, ", ", " and "));
}

std::string Section::field(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void Section::refuse(const toml::node& at, std::string_view key, const std::string& sentence) const {
  source_.refuse(line_of(at.source()), field(key), sentence);
}

void Section::refuse_missing(std::string_view key, const std::string& sentence) const {
  source_.refuse(std::max(line_of(table_.source()), 1), field(key), sentence);
}

template <class T>
std::optional<T> Section::value(std::string_view key, const char* expected) const {
  const toml::node* const found = node(key);
  if (!found) return std::nullopt;
  if (!found->is<T>()) refuse(*found, key, std::string("must be ") + expected);
  return found->value_exact<T>();
}

std::optional<std::string> Section::text(std::string_view key) const {
  return value<std::string>(key, "a text in quotes");
}

std::optional<bool> Section::flag(std::string_view key) const { return value<bool>(key, "true or false"); }

std::optional<int> Section::number(std::string_view key, int least, int most) const {
  const std::optional<std::int64_t> number = value<std::int64_t>(key, "a whole number");
  if (!number) return std::nullopt;
  if (*number < least || *number > most)
    refuse(*node(key), key,
           std::to_string(*number) + " is out of range; accepted: " + std::to_string(least) + " to " +
               std::to_string(most));
  return static_cast<int>(*number);
}

const toml::array* Section::list(std::string_view key) const {
  const toml::node* const found = node(key);
  if (found && !found->is_array()) refuse(*found, key, "must be a list in [ ]");
  return found ? found->as_array() : nullptr;
}

const toml::table* Section::table(std::string_view key) const {
  const toml::node* const found = node(key);
  if (found && !found->is_table()) refuse(*found, key, "must be a table");
  return found ? found->as_table() : nullptr;
}

std::optional<int> Section::choice(std::string_view key, const std::vector<std::string>& words) const {
  const std::optional<std::string> word = text(key);
  if (!word) return std::nullopt;
  const auto found = std::find(words.begin(), words.end(), *word);
  if (found == words.end())
    refuse(*node(key), key,
           "unknown value " + racebeam::quoted(*word) + "; accepted: " + join(words, ", ", " and "));
  return static_cast<int>(found - words.begin());
}

void Section::guard(const toml::node& at, std::string_view key, const std::function<void()>& work) const {
  try {
    work();
  } catch (const SourceError&) {
    throw;  // it knows the line more exactly
  } catch (const InvalidInput& error) {
    refuse(at, key, error.what());
  }
}

void Section::compile(std::string_view key, const std::function<void(std::string_view)>& compiler) const {
  const std::optional<std::string> code = text(key);
  if (!code) return;
  const toml::node& at = *node(key);
  try {
    guard(at, key, [&] { compiler(*code); });
  } catch (const SourceError& error) {
    source_.refuse(first_line(at) + error.line - 1, field(key), error.what());
  }
}

// TOML drops a line end right after the opening ''' or """. The text then starts on the next line.
int Section::first_line(const toml::node& text) const {
  const int line = line_of(text.source());
  std::size_t at = 0;
  for (int i = 1; i < line; ++i) at = source_.text.find('\n', at) + 1;
  std::string_view rest = source_.text.substr(at + text.source().begin.column - 1);
  if (!rest.starts_with("'''") && !rest.starts_with("\"\"\"")) return line;
  rest.remove_prefix(3);
  return rest.starts_with('\n') || rest.starts_with("\r\n") ? line + 1 : line;
}

}  // namespace racebeam
