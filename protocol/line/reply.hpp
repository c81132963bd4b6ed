// The reply to a request: only keys that protocol/protocol.toml describes. A misspelt key does not compile,
// and an assertion refuses one that is another command's.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "protocol/description/tables.hpp"
#include "protocol/request_error.hpp"

namespace racebeam {

struct Command;

// The key of a pair, written as text.
class ReplyKey {
 public:
  template <std::size_t size>
  consteval ReplyKey(const char (&text)[size]) : text_(text, size - 1) {  // NOLINT: from text, on purpose
    if (std::ranges::find(description::kReplyKeys, text_) == description::kReplyKeys.end())
      throw "protocol.toml has no reply with this key";
  }
  std::string_view text() const { return text_; }

 private:
  std::string_view text_;
};

// Replies that wait to be sent, and the one that is being written.
class Reply {
 public:
  // Handlers call these. "ok" is written before.
  void add(ReplyKey key, std::int64_t number);
  void add(ReplyKey key, std::string_view text);
  void add(ReplyKey key, std::span<const int> numbers);  // 0,1,2
  template <typename Texts>
  void add_list(ReplyKey key, const Texts& texts, char between = ',') {
    std::string& out = add_long(key);
    bool first = true;
    for (const auto& text : texts) {
      if (!first) out += between;
      out += text;
      first = false;
    }
  }
  // The text to which a long value of the key is appended.
  std::string& add_long(ReplyKey key);
  // Begins another group.
  void add_group();
  // Appends fields: show(text, bytes after the line).
  template <typename Show>
  void add_fields(Show show) {
    check_fields();
    show(out_, raw_);
  }
  // Appends the settings that `load` echoes, and text for people.
  template <typename Append>
  void add_settings(Append append) {
    check_settings();
    append(out_);
  }
  std::string& add_help();
  void reserve(std::size_t more, std::size_t more_raw);

  // The session calls these.
  void begin();                         // a request
  void answer(const Command& command);  // with "ok"; its keys are checked
  void drop();                          // what was written since begin()
  void refuse(ErrorCode code, std::string_view sentence);
  std::size_t finish();  // returns its bytes
  std::size_t begin_of_last() const { return begin_; }
  std::string_view text() const { return out_; }
  void sent(std::size_t count);
  std::string& text_memory() { return out_; }
  std::string& raw_memory() { return raw_; }
  std::size_t capacity() const { return out_.capacity() + raw_.capacity(); }

 private:
  void check(std::string_view key) const;
  void check_fields() const;
  void check_settings() const;

  std::string out_;
  std::string raw_;        // bytes that follow the line of the current reply
  std::size_t begin_ = 0;  // of the current reply in out_
  const Command* command_ = nullptr;
  bool in_groups_ = false;
};

}  // namespace racebeam
