#include "protocol/line/reply.hpp"

#include <cassert>

#include "protocol/line/command.hpp"

namespace racebeam {
namespace {

// Whether a list such as "game:text image?:text" has the key.
[[maybe_unused]] bool has(std::string_view described, std::string_view key) {
  for (std::string_view word = next_word(described); !word.empty(); word = next_word(described)) {
    cut_behind(word, ':');
    if (word.ends_with('?')) word.remove_suffix(1);
    if (word == key) return true;
  }
  return false;
}

// A sentence may quote text that the client sent as base64, and that may be any bytes.
void append_printable(std::string& out, std::string_view sentence) {
  for (const char c : sentence) out += c < ' ' || c > '~' ? '?' : c;
}

}  // namespace

void Reply::check([[maybe_unused]] std::string_view key) const {
  assert(command_ != nullptr);
  assert(has(in_groups_ ? command_->groups : command_->reply, key) &&
         "protocol.toml does not list this key for the command");
}

void Reply::check_fields() const {
  assert(command_ != nullptr);
  assert((command_->shows == "groups") == in_groups_ || command_->name == "restore");
  assert(!command_->shows.empty());
}

void Reply::check_settings() const { assert(command_ != nullptr && command_->echoes == "settings"); }

void Reply::add(ReplyKey key, std::int64_t number) { append_number(add_long(key), number); }
void Reply::add(ReplyKey key, std::string_view text) { add_long(key) += text; }
void Reply::add(ReplyKey key, std::span<const int> numbers) { append_list(add_long(key), numbers); }

std::string& Reply::add_long(ReplyKey key) {
  check(key.text());
  append_pair(out_, key.text(), "");
  return out_;
}

void Reply::add_group() {
  out_ += " |";
  in_groups_ = true;
}

std::string& Reply::add_help() { return out_ += ' '; }

void Reply::reserve(std::size_t more, std::size_t more_raw) {
  out_.reserve(out_.size() + more);
  raw_.reserve(raw_.size() + more_raw);
}

void Reply::begin() {
  begin_ = out_.size();
  command_ = nullptr;
  in_groups_ = false;
}

void Reply::answer(const Command& command) {
  command_ = &command;
  out_ += "ok";
}

void Reply::drop() {
  out_.resize(begin_);
  raw_.clear();
}

void Reply::refuse(ErrorCode code, std::string_view sentence) {
  drop();
  ((out_ += "error ") += name_of(code)) += ' ';
  append_printable(out_, sentence);
}

std::size_t Reply::finish() {
  const bool has_raw = !raw_.empty();
  if (has_raw) append_pair(out_, "raw", static_cast<std::int64_t>(raw_.size()));
  out_ += '\n';
  if (has_raw) {
    out_ += raw_;
    raw_.clear();
  }
  return out_.size() - begin_;
}

void Reply::sent(std::size_t count) {
  out_.erase(0, count);
  begin_ -= std::min(begin_, count);
}

}  // namespace racebeam
