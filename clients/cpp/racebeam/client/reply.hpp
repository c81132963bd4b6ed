/// @file
/// The reply to a request, with its groups of keys and values. Any number of threads may read one.
#pragma once

#include <charconv>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "racebeam/client/config.hpp"
#include "racebeam/client/encoding.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

namespace detail {

/// A number that is the whole of a text.
template <class Number>
Number to_number(std::string_view text) {
  Number number{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc{} || end != text.data() + text.size())
    throw std::invalid_argument(std::string("not a number: '").append(text.substr(0, 60)).append("'"));
  return number;
}

/// The words of a text, between separators. An empty text has no words.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return parts;
}

}  // namespace detail

/// Pairs KEY=VALUE of a reply: about the request as a whole, about a machine, or about a branch.
class Group {
 public:
  /// A value. `bytes` is filled if it is a field of bytes, and decoded.
  struct Value {
    std::string_view key, text;  ///< as the server sent them
    bool is_bytes = false;
    Bytes bytes;
  };

  /// Whether the server sent the key.
  bool has(std::string_view key) const noexcept { return find(key) != nullptr; }

  /// The value as the server sent it. Throws std::out_of_range if the reply lacks the key, as do all below.
  std::string text(std::string_view key) const { return std::string(value(key).text); }

  /// The value as a number. Throws std::invalid_argument if it does not have this type.
  template <class Number = std::int64_t>
  Number number(std::string_view key) const {
    return detail::to_number<Number>(value(key).text);
  }

  /// The words of a value that are separated by commas.
  std::vector<std::string> list(std::string_view key) const {
    const auto words = detail::split(value(key).text, ',');
    return {words.begin(), words.end()};
  }

  /// A field of bytes, decoded. Throws std::invalid_argument if the field does not have bytes.
  const Bytes& bytes(std::string_view field) const& {
    const Value& found = value(field);
    if (!found.is_bytes) throw std::invalid_argument(std::string(field).append(" is not a field of bytes"));
    return found.bytes;
  }
  Bytes bytes(std::string_view field) && {
    return std::as_const(*this).bytes(field);
  }  ///< of a temporary group

  /// The reward of player A.
  std::int64_t reward() const { return number("reward"); }
  /// The lives that remain.
  int lives() const { return number<int>("lives"); }
  /// Whether the episode has ended.
  bool over() const { return value("terminated").text == "1" || value("truncated").text == "1"; }

  /// The values in the order in which they were sent.
  const std::vector<Value>& values() const noexcept { return values_; }

 private:
  friend class Reply;

  const Value* find(std::string_view key) const noexcept {
    for (const Value& each : values_)
      if (each.key == key) return &each;
    return nullptr;
  }

  const Value& value(std::string_view key) const {
    if (const Value* found = find(key)) return *found;
    std::string keys;
    for (const Value& each : values_) keys.append(" ").append(each.key);
    throw std::out_of_range(std::string("the reply has no ").append(key).append("; it has").append(keys));
  }

  std::vector<Value> values_;
  std::shared_ptr<const std::string> line_;  // what the views refer to
};

/// What the server answered: one group about the request as a whole, and one for each machine or branch.
class Reply {
 public:
  Reply() = default;

  /// The groups of a line that begins with `ok`. `decode(Group::Value&, group)` decodes values.
  template <class Decode>
  Reply(std::string line, const Decode& decode)
      : line_(std::make_shared<const std::string>(std::move(line))) {
    begin_group();
    for (const std::string_view word : detail::split(*line_, ' ')) {
      const std::size_t equals = word.find('=');
      if (word == "|") {
        begin_group();
      } else if (equals != std::string_view::npos) {
        Group::Value& value = groups_.back().values_.emplace_back();
        value.key = word.substr(0, equals);
        value.text = word.substr(equals + 1);
        decode(value, groups_.size() - 1);
      }
    }
  }

  /// The line, without its end.
  const std::string& line() const noexcept { return *line_; }
  /// All groups.
  const std::vector<Group>& groups() const noexcept { return groups_; }
  /// The group about the request as a whole.
  const Group& first() const { return groups_.front(); }
  /// The groups of machines or branches.
  std::vector<Group> rest() const { return {groups_.begin() + 1, groups_.end()}; }

 private:
  void begin_group() { groups_.emplace_back().line_ = line_; }

  std::shared_ptr<const std::string> line_ = std::make_shared<const std::string>();
  std::vector<Group> groups_;
};

/// What a list of actions led to, in the reply of `branch`.
struct Branch {
  std::vector<std::int64_t> rewards;    ///< of each act
  std::vector<std::int64_t> rewards_b;  ///< of player B, if the game's rules have one
  Group group;                          ///< reward, acts, lives, terminated, truncated, and state with `keep`
};

/// The rewards of a text such as `0*8,1,0*5`.
inline std::vector<std::int64_t> unfold_rewards(std::string_view text) {
  std::vector<std::int64_t> rewards;
  for (const std::string_view run : detail::split(text, ',')) {
    const std::size_t star = run.find('*');
    const auto times =
        star == std::string_view::npos ? 1 : detail::to_number<std::size_t>(run.substr(star + 1));
    rewards.insert(rewards.end(), times, detail::to_number<std::int64_t>(run.substr(0, star)));
  }
  return rewards;
}

}  // namespace RACEBEAM_CLIENT_NAMESPACE
