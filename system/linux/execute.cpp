#include "system/program/execute.hpp"

#include <unistd.h>

#include <cerrno>

namespace racebeam {

int execute(const std::vector<std::string>& words) {
  std::vector<char*> texts;
  for (const std::string& word : words) texts.push_back(const_cast<char*>(word.c_str()));
  texts.push_back(nullptr);
  ::execvp(texts[0], texts.data());
  return errno;
}

}  // namespace racebeam
