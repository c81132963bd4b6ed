// A child process that runs another program, which encodes a film.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "system/child_program.hpp"

namespace racebeam {

class EncoderFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Not thread-safe. The program reads what write() sends. If it fails, the last line on its standard error is
// the reason. All members throw EncoderFailed if the program does not exist, fails, or does not make progress
// for the time of `patience`, or if the caller has given up.
class FilmEncoder {
 public:
  // words: the program, which is searched for in the PATH, and its arguments.
  // given_up: called from time to time while another call waits; true: the caller has given up.
  explicit FilmEncoder(std::vector<std::string> words, std::function<bool()> given_up = {},
                       std::chrono::milliseconds patience = std::chrono::seconds(20));

  void write(std::string_view bytes);
  void finish();  // ends the input, and waits until the program has succeeded

 private:
  using Time = std::chrono::steady_clock::time_point;

  void check_patience(Time begin) const;
  void wait_for_end();
  [[noreturn]] void fail(const std::string& otherwise);
  std::string last_words();

  std::string name_, said_;  // said_: what it has written to standard error
  std::function<bool()> given_up_;
  std::chrono::milliseconds patience_;
  std::unique_ptr<ChildProgram> program_;
};

}  // namespace racebeam
