// Words of requests that have a new name. The server accepts the old one, and logs a warning once.
#pragma once

#include <array>
#include <atomic>
#include <string>
#include <string_view>

#include "protocol/description/tables.hpp"

namespace racebeam {

using OldWord = description::OldWord;

constexpr std::string_view kOfFields = "field";

// The row of a word, a pair KEY=VALUE or a field, that a request of this command has; null: it is not old.
const OldWord* old_word(std::string_view command, std::string_view word);
const OldWord* old_field(std::string_view word);

// The new word for it.
std::string new_word(const OldWord& row, std::string_view word);

std::string deprecation_of(const OldWord& row);  // for help and the log

// The rows that clients of a server have used. Thread-safe.
class UsedOldWords {
 public:
  // Whether it is used for the first time.
  bool add(const OldWord& row) {
    const auto place = static_cast<std::size_t>(&row - description::kOldWords.data());
    return !used_[place].load(std::memory_order_relaxed) && !used_[place].exchange(true);
  }

 private:
  std::array<std::atomic<bool>, description::kOldWords.size()> used_{};
};

}  // namespace racebeam
