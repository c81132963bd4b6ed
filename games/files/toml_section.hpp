// Reads one table of a game file. Errors name the place and the remedy: "FILE:LINE: FIELD: sentence".
#pragma once

#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "games/files/toml.hpp"
#include "games/language/lexer.hpp"

namespace racebeam {

// The text of a file, and its name for errors. It must outlive its sections.
struct TomlSource {
  std::string_view text;
  std::string file;

  [[noreturn]] void refuse(int line, const std::string& field, const std::string& sentence) const;
};

toml::table parse_toml(const TomlSource& source);

class Section {
 public:
  // path: "" for the whole file. base: a table for keys that `table` lacks, or null.
  Section(const TomlSource& source, const toml::table& table, std::string path,
          const toml::table* base = nullptr);

  void allow(std::span<const std::string_view> keys) const;  // refuses all others
  void allow(std::initializer_list<std::string_view> keys) const {
    allow(std::span(keys.begin(), keys.size()));
  }

  const toml::node* node(std::string_view key) const;  // null if the key is absent

  // Each returns nothing if the key is absent, and refuses another type, and numbers out of range.
  std::optional<std::string> text(std::string_view key) const;
  std::optional<int> number(std::string_view key, int least = std::numeric_limits<int>::min(),
                            int most = std::numeric_limits<int>::max()) const;
  std::optional<bool> flag(std::string_view key) const;
  const toml::array* list(std::string_view key) const;
  const toml::table* table(std::string_view key) const;

  // Passes the text of `key` to a compiler, whose errors name the line within the text.
  void compile(std::string_view key, const std::function<void(std::string_view)>& compiler) const;

  // Runs `work`, and refuses its InvalidInput as an error of this key.
  void guard(const toml::node& at, std::string_view key, const std::function<void()>& work) const;

  // Returns the index in `words` of the text of `key`.
  std::optional<int> choice(std::string_view key, const std::vector<std::string>& words) const;

  [[noreturn]] void refuse(const toml::node& at, std::string_view key, const std::string& sentence) const;
  [[noreturn]] void refuse_missing(std::string_view key, const std::string& sentence) const;

 private:
  template <class T>
  std::optional<T> value(std::string_view key, const char* expected) const;
  std::string field(std::string_view key) const;
  int first_line(const toml::node& text) const;

  const TomlSource& source_;
  const toml::table& table_;
  std::string path_;
  const toml::table* base_;
};

}  // namespace racebeam
