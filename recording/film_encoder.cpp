#include "recording/film_encoder.hpp"

#include <system_error>
#include <thread>
#include <utility>

#include "system/printable.hpp"

namespace racebeam {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLongestReason = 300;  // characters

std::unique_ptr<ChildProgram> started(const std::vector<std::string>& words) try {
  return std::make_unique<ChildProgram>(words);
} catch (const std::system_error& error) {
  if (error.code() == std::errc::no_such_file_or_directory)
    throw EncoderFailed(words[0] + " is not installed: the PATH has no such program");
  throw EncoderFailed(error.what());
}

}  // namespace

FilmEncoder::FilmEncoder(std::vector<std::string> words, std::function<bool()> given_up,
                         std::chrono::milliseconds patience)
    : name_(words.at(0)), given_up_(std::move(given_up)), patience_(patience), program_(started(words)) {}

void FilmEncoder::write(std::string_view bytes) {
  const Time begin = std::chrono::steady_clock::now();
  while (!bytes.empty()) {
    const std::ptrdiff_t sent = program_->send(bytes);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (sent == 0) {
      check_patience(begin);
    } else {
      wait_for_end();
      fail("it does not read any more");
    }
  }
}

void FilmEncoder::finish() {
  program_->close_input();
  wait_for_end();
  if (!program_->has_succeeded()) fail("it did not succeed");
}

void FilmEncoder::wait_for_end() {
  constexpr auto kBetweenLooks = 2ms;
  const Time begin = std::chrono::steady_clock::now();
  while (!program_->has_ended()) {
    check_patience(begin);
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

void FilmEncoder::check_patience(Time begin) const {
  if (given_up_ && given_up_()) throw EncoderFailed(name_ + " is not waited for any more");
  if (std::chrono::steady_clock::now() > begin + patience_)
    throw EncoderFailed(name_ + (program_->has_input() ? " does nothing any more" : " does not end"));
}

void FilmEncoder::fail(const std::string& otherwise) {
  const std::string words = last_words();
  throw EncoderFailed(name_ + " failed: " + (words.empty() ? otherwise : words));
}

// The last line of the program's errors, or the beginning of a long one.
std::string FilmEncoder::last_words() {
  said_ += program_->errors();
  while (said_.ends_with('\n') || said_.ends_with('\r')) said_.pop_back();
  return printable(said_.substr(said_.rfind('\n') + 1, kLongestReason));
}

}  // namespace racebeam
