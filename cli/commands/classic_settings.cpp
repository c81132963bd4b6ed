#include "cli/commands/classic_settings.hpp"

#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "server/operation/log.hpp"
#include "system/input_file.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr auto kBlanks = " \t\r";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

bool is_key(const std::string& word) { return word.starts_with('-'); }

[[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& accepted) {
  throw std::invalid_argument("-" + key + " is '" + value + "'; it takes " + accepted);
}

// more: what is accepted besides a whole number.
template <typename Number>
Number whole_number(const std::string& key, const std::string& value, const std::string& more) {
  using Limits = std::numeric_limits<Number>;
  if (const auto number = parse_number<Number>(value)) return *number;
  refuse(
      key, value,
      "a whole number from " + std::to_string(Limits::min()) + " to " + std::to_string(Limits::max()) + more);
}

}  // namespace

ClassicSettings::ClassicSettings(const std::vector<std::string>& words) {
  if (std::filesystem::exists("ale.cfg")) read_file("ale.cfg");
  read_words(words);
  const std::string config = text("config");
  if (!config.empty()) read_file(config);
}

bool ClassicSettings::asks_for(const std::string& word, const std::vector<std::string>& words) {
  for (std::size_t at = 0; at < words.size() && is_key(words[at]); at += 2) {
    if (words[at] == word) return true;
  }
  return false;
}

// A key takes the next word, whatever it is. The first word that is not a key is the image; later words are
// ignored.
void ClassicSettings::read_words(const std::vector<std::string>& words) {
  std::size_t at = 0;
  for (; at < words.size() && is_key(words[at]); at += 2) {
    if (at + 1 == words.size()) throw std::invalid_argument(words[at] + " has no value");
    values_[words[at].substr(1)] = words[at + 1];
  }
  if (at >= words.size())
    throw std::invalid_argument("the image is missing; it comes after all keys and their values");
  image_ = words[at];
}

void ClassicSettings::read_file(const std::string& path) try {
  constexpr std::size_t kLargestFile = 1 << 20;
  std::istringstream file(read_input_file("cannot read the configuration", path, kLargestFile));
  for (std::string line; std::getline(file, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos || line.starts_with('#') || line.starts_with(';')) continue;
    values_[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
} catch (const InputFileError& error) {
  log(std::string(error.what()) + "; it is ignored");
}

std::string ClassicSettings::text(const std::string& key) const {
  const auto found = values_.find(key);
  return found == values_.end() ? std::string{} : found->second;
}

int ClassicSettings::number(const std::string& key, int otherwise) const {
  const std::string value = text(key);
  return value.empty() ? otherwise : whole_number<int>(key, value, "");
}

std::uint32_t ClassicSettings::seed(const std::string& key) const {
  const std::string value = text(key);
  return value.empty() || value == "time" ? 0 : whole_number<std::uint32_t>(key, value, ", or time");
}

float ClassicSettings::real(const std::string& key, float otherwise) const {
  const std::string value = text(key);
  if (value.empty()) return otherwise;
  if (const auto number = parse_number<float>(value)) return *number;
  refuse(key, value, "a number, such as 0.25");
}

bool ClassicSettings::truth(const std::string& key, bool otherwise) const {
  const std::string value = text(key);
  return value.empty() ? otherwise : value == "1" || value == "true";
}

}  // namespace racebeam
