#include "cli/actions.hpp"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace racebeam {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::invalid_argument("can't read actions from '" + path + "': " + why);
}

// zlib hands plain bytes on as they are.
std::string contents(const std::string& path) {
  const auto close = [](gzFile file) { gzclose(file); };
  const std::unique_ptr<gzFile_s, decltype(close)> file{
      path == "-" ? gzdopen(dup(STDIN_FILENO), "rb") : gzopen(path.c_str(), "rb"), close};
  if (!file) refuse(path, std::strerror(errno));

  std::string text;
  std::array<char, 65536> chunk;
  int count = 0;
  while ((count = gzread(file.get(), chunk.data(), chunk.size())) > 0) text.append(chunk.data(), count);

  int error = Z_OK;
  const char* message = gzerror(file.get(), &error);
  if (error != Z_OK) refuse(path, error == Z_ERRNO ? std::strerror(errno) : message);
  return text;
}

// The beginning of a word, fit for a message.
std::string quoted(std::string word) {
  word.resize(std::min<std::size_t>(word.size(), 40));
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + word + "'";
}

int number(const std::string& path, int line, const std::string& word) {
  int value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc{} || stop != end) {
    refuse(path, "line " + std::to_string(line) + ": " + quoted(word) + " is not a number");
  }
  return value;
}

bool is_silent(const std::string& word) { return word[0] == '#' || word == "R" || word == "S"; }

}  // namespace

std::vector<ScriptedAction> read_actions(const std::string& path) {
  std::vector<ScriptedAction> actions;
  std::istringstream text{contents(path)};
  std::string row, word;
  for (int line = 1; std::getline(text, row); ++line) {
    std::istringstream words{row};
    if (!(words >> word) || is_silent(word)) continue;
    const bool one_only = word == "A";
    if (one_only && !(words >> word))
      refuse(path, "line " + std::to_string(line) + ": the action is missing after 'A'");
    do {
      actions.push_back({number(path, line, word), line});
    } while (!one_only && words >> word);
  }
  return actions;
}

}  // namespace racebeam
