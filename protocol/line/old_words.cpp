#include "protocol/line/old_words.hpp"

#include <algorithm>

namespace racebeam {
namespace {

using description::kOldWords;

bool is_key(std::string_view old) { return old.find('=') == old.npos; }

// Whether a word of a request is what a row has: the pair, or a pair with the row's key.
bool is_old(std::string_view word, std::string_view old) {
  return is_key(old) ? word.starts_with(old) && word.substr(old.size()).starts_with('=') : word == old;
}

// Whether a field is what a row has. N stands for a number.
bool is_old_field(std::string_view name, std::string_view old) {
  if (!old.ends_with('N')) return name == old;
  old.remove_suffix(1);
  if (!name.starts_with(old) || name.size() == old.size()) return false;
  return name.find_first_not_of("0123456789", old.size()) == name.npos;
}

}  // namespace

const OldWord* old_word(std::string_view command, std::string_view word) {
  const auto found = std::ranges::find_if(
      kOldWords, [&](const OldWord& row) { return row.of == command && is_old(word, row.old); });
  return found == kOldWords.end() ? nullptr : &*found;
}

const OldWord* old_field(std::string_view word) {
  const std::string_view name = word.substr(0, word.find(':'));
  const auto found = std::ranges::find_if(
      kOldWords, [&](const OldWord& row) { return row.of == kOfFields && is_old_field(name, row.old); });
  return found == kOldWords.end() ? nullptr : &*found;
}

std::string new_word(const OldWord& row, std::string_view word) {
  std::string text(row.now);
  return is_key(row.old) ? text.append(word.substr(row.old.size())) : text;
}

std::string deprecation_of(const OldWord& row) {
  std::string text(row.of);
  (((text += ' ') += row.old) += " is deprecated: use ") += row.now;
  return text;
}

}  // namespace racebeam
