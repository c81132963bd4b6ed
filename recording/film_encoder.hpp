// Another program that makes a film out of what it reads: a child process.
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

// Not thread-safe. The program reads what write() sends. Its last line on standard error is the reason of a
// failure. All throw EncoderFailed if the program is not there, fails, or does nothing for the time of
// `patience`, or if the caller has given up.
class FilmEncoder {
 public:
  // `words`: the program, found as a shell does, and its arguments.
  // given_up: asked now and then while another call waits.
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

  std::string name_, said_;  // on standard error
  std::function<bool()> given_up_;
  std::chrono::milliseconds patience_;
  std::unique_ptr<ChildProgram> program_;
};

}  // namespace racebeam
