// Compares replies with the keys and types that protocol/protocol.toml describes.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "environment/settings/play_settings.hpp"
#include "protocol/line/commands/command_table.hpp"
#include "protocol/line/field.hpp"
#include "protocol/request_error.hpp"
#include "system/named_rows.hpp"
#include "system/words.hpp"

namespace racebeam::test {

class ReplyCheck {
 public:
  ReplyCheck(const std::string& request, const std::string& reply) : request_(request), reply_(reply) {}

  void run() const {
    std::vector<std::string_view> words, request;
    split(reply_, words);
    split(request_, request);
    if (words.empty() || request.empty() || reply_.find('\n') != reply_.npos)
      return;  // no reply, or bytes behind it
    if (words[0] == "error") return check_error(words);
    if (words[0] != "ok") fail("begins with neither ok nor error");
    const std::string_view name = request[0] == "exit" ? "quit" : request[0] == "?" ? "help" : request[0];
    const auto row = std::ranges::find(commands(), name, &Command::name);
    if (row == commands().end()) fail("answers a command that is not described");
    if (name != "help") check_groups(*row, Words(words).subspan(1));
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::logic_error("the reply to '" + request_.substr(0, 80) + "' " + what + ": " +
                           reply_.substr(0, 300));
  }

  void check_error(Words words) const {
    const auto names = names_of(codes());
    if (words.size() < 3) fail("has no code or no sentence");
    if (std::ranges::find(names, words[1]) == names.end()) fail("has a code that is not described");
  }

  void check_groups(const Command& row, Words words) const {
    for (bool first = true; first || !words.empty(); first = false) {
      const auto end = std::ranges::find(words, std::string_view("|"));
      const auto count = static_cast<std::size_t>(end - words.begin());
      check_group(row, words.first(count), first);
      words = words.subspan(std::min(count + 1, words.size()));
    }
  }

  void check_group(const Command& row, Words words, bool first) const {
    std::vector<std::string_view> described;
    split(first ? row.reply : row.groups, described);
    const bool shows = first ? row.shows == "first" || row.shows == "asked" : row.shows == "groups";
    std::set<std::string_view> there;
    for (const std::string_view word : words) {
      const auto [key, value] = key_value(word);
      if (!there.insert(key).second) fail("has the key " + std::string(key) + " twice");
      check_pair(row, described, shows, key, value);
    }
    for (std::string_view key : described) {
      cut_behind(key, ':');
      if (!key.ends_with('?') && !there.contains(key)) fail("lacks the key " + std::string(key));
    }
  }

  void check_pair(const Command& row, Words described, bool shows, std::string_view key,
                  std::string_view value) const {
    for (std::string_view name : described) {
      const std::string_view type = cut_behind(name, ':');
      if (name.ends_with('?')) name.remove_suffix(1);
      if (name == key) return check_value(key, type, value);
    }
    const bool is_setting = row.echoes == "settings" &&
                            std::ranges::find(setting_rows(), key, &SettingRow::name) != setting_rows().end();
    if (!is_setting && key != "raw" && !(shows && is_field(key)))
      fail("has the key " + std::string(key) + ", which is not described");
  }

  static bool is_field(std::string_view key) {
    if (key.starts_with("final_")) key.remove_prefix(6);
    return std::ranges::find(field_rows(), row_of_field(key), &FieldRow::name) != field_rows().end();
  }

  void check_value(std::string_view key, std::string_view type, std::string_view value) const {
    if (!is_of(type, value))
      fail("has " + std::string(key) + "=" + std::string(value.substr(0, 40)) +
           ", which is not of the type " + std::string(type));
  }

  static bool is_of(std::string_view type, std::string_view value) {
    const auto all = [value](std::string_view accepted) {
      return value.find_first_not_of(accepted) == value.npos;
    };
    if (type == "int") return parse_number<std::int64_t>(value).has_value();
    if (type == "real") return parse_number<double>(value).has_value();
    if (type == "flag") return value == "0" || value == "1";
    if (type == "ints") return all("0123456789,");
    if (type == "hex") return all("0123456789ABCDEF") && value.size() % 2 == 0;
    if (type == "rewards") return !value.empty() && all("0123456789,*-");
    return true;
  }

  const std::string &request_, &reply_;
};

// Throws std::logic_error if the reply is not as described.
inline void check_reply(const std::string& request, const std::string& reply) {
  ReplyCheck(request, reply).run();
}

}  // namespace racebeam::test
