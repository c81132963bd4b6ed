// Reads one table of a game file, with errors that a person can act on: "FILE:LINE: FIELD: sentence".
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "games/files/toml.hpp"
#include "games/language/lexer.hpp"

namespace racebeam {

// A file's text and how errors call it; outlives its sections.
struct TomlSource {
  std::string_view text;
  std::string file;

  [[noreturn]] void refuse(int line, const std::string& field, const std::string& sentence) const;
};

toml::table parse_toml(const TomlSource& source);

class Section {
 public:
  // `path` is "" for the whole file. What `table` hasn't got is looked for in `base`, if there is one.
  Section(const TomlSource& source, const toml::table& table, std::string path,
          const toml::table* base = nullptr);

  void allow(std::initializer_list<std::string_view> keys) const;  // refuses all others

  const toml::node* node(std::string_view key) const;  // null if the key is absent

  // Nothing if the key is absent; refused if it is something else.
  std::optional<std::string> text(std::string_view key) const;
  std::optional<int> number(std::string_view key) const;
  std::optional<bool> flag(std::string_view key) const;
  const toml::array* list(std::string_view key) const;
  const toml::table* table(std::string_view key) const;

  // Hands the text of `key` to a compiler; its errors name the line within the text.
  void compile(std::string_view key, const std::function<void(std::string_view)>& compiler) const;

  // Runs `work`; its InvalidInput is refused as an error of this key.
  void guard(const toml::node& at, std::string_view key, const std::function<void()>& work) const;

  // One of a list of words, by its number.
  std::optional<int> choice(std::string_view key, const std::vector<std::string>& words) const;

  [[noreturn]] void refuse(const toml::node& at, std::string_view key, const std::string& sentence) const;
  [[noreturn]] void refuse_missing(std::string_view key, const std::string& sentence) const;

 private:
  template <class T>
  std::optional<T> value(std::string_view key, const char* wanted) const;
  std::string field(std::string_view key) const;
  int first_line(const toml::node& text) const;

  const TomlSource& source_;
  const toml::table& table_;
  std::string path_;
  const toml::table* base_;
};

}  // namespace racebeam
