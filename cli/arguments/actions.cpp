#include "cli/arguments/actions.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "system/input_file.hpp"
#include "system/program/standard_streams.hpp"
#include "system/regular_file.hpp"

namespace racebeam {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::invalid_argument("cannot read actions from '" + path + "': " + why);
}

// zlib passes files through that are not gzip.
std::string contents(const std::string& path) {
  const auto close = [](gzFile file) { gzclose(file); };
  const std::unique_ptr<gzFile_s, decltype(close)> file{
      gzdopen(path == "-" ? duplicate_descriptor(kStandardInput)
                          : open_input_file("cannot read actions from", path),
              "rb"),
      close};
  if (!file) refuse(path, std::strerror(errno));

  constexpr std::size_t kLargest = 1 << 28;  // bytes, inflated
  std::string text;
  std::array<char, 65536> chunk;
  int count = 0;
  while ((count = gzread(file.get(), chunk.data(), chunk.size())) > 0) {
    text.append(chunk.data(), count);
    if (text.size() > kLargest) refuse(path, "larger than " + std::to_string(kLargest) + " bytes");
  }

  int error = Z_OK;
  const char* message = gzerror(file.get(), &error);
  if (error != Z_OK) refuse(path, error == Z_ERRNO ? std::strerror(errno) : message);
  return text;
}

// The beginning of a word, shortened for a message.
std::string quoted(std::string word) {
  word.resize(std::min<std::size_t>(word.size(), 40));
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + word + "'";
}

template <typename Number>
std::optional<Number> parse(const std::string& word) {
  Number value{};
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  return error == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

// A file that is being read. Errors name it and the line.
class Script {
 public:
  explicit Script(const std::string& path) : path_(path), text_(contents(path)) {}

  std::vector<ScriptedStep> steps() {
    std::string row;
    while (std::getline(text_, row)) {
      ++line_;
      std::istringstream words{row};
      read_line(words);
    }
    return std::move(steps_);
  }

  [[noreturn]] void refuse_line(int line, const std::string& why) const {
    refuse(path_, "line " + std::to_string(line) + ": " + why);
  }

 private:
  void read_line(std::istringstream& words) {
    std::string word;
    if (!(words >> word) || word[0] == '#' || word == "R" || word == "S") return;
    if (word == "A") {
      if (!(words >> word)) refuse_line(line_, "the action is missing after 'A'");
      return add_action(word);
    }
    if (word == "M") return add_write(words);
    do add_action(word);
    while (words >> word);
  }

  int number(const std::string& word) const {
    const auto value = parse<int>(word);
    if (!value) refuse_line(line_, quoted(word) + " is not a number");
    return *value;
  }

  void add_action(const std::string& word) {
    const std::size_t at = word.find('@');
    ScriptedStep step{line_, number(word.substr(0, at))};
    if (at != std::string::npos) step.strength = strength(word.substr(at + 1));
    steps_.push_back(step);
  }

  float strength(const std::string& word) const {
    const auto value = parse<float>(word);
    const bool accepted = value && std::abs(*value) <= kMaxStrength;  // false for NaN
    if (!accepted) refuse_line(line_, quoted(word) + " is not a strength from -1000 to 1000");
    return *value;
  }

  void add_write(std::istringstream& words) {
    std::string index, value;
    if (!(words >> index >> value)) refuse_line(line_, "'M' requires an index and a value");
    const RamWrite write{number(index), static_cast<std::uint8_t>(number(value))};
    if (write.index < 0 || write.index > 127)
      refuse_line(line_, "the index of a byte of RAM must be 0 to 127, not " + index);
    if (number(value) != write.value)
      refuse_line(line_, "the value of a byte must be 0 to 255, not " + value);
    steps_.push_back({.line = line_, .write = write});
  }

  static constexpr float kMaxStrength = 1000;

  std::string path_;
  std::istringstream text_;
  int line_ = 0;
  std::vector<ScriptedStep> steps_;
};

}  // namespace

std::vector<ScriptedStep> read_script(const std::string& path) { return Script(path).steps(); }

std::vector<int> read_actions(const std::string& path) {
  Script script(path);
  std::vector<int> actions;
  for (const ScriptedStep& step : script.steps()) {
    if (step.write || step.strength != 1) script.refuse_line(step.line, "only actions are accepted here");
    actions.push_back(step.action);
  }
  return actions;
}

}  // namespace racebeam
