// One session of the text protocol of ALE 0.4 to 0.6 (docs/spec/classic-protocol.md; for clients:
// protocol/CLASSIC.md). It does not use files or sockets: bytes go in, lines of text come out.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "environment/environment.hpp"
#include "protocol/classic/classic_line_buffer.hpp"

namespace racebeam {

// The client sent an invalid line; the session is over.
class ClassicError : public std::runtime_error {
 public:
  ClassicError(int status, const std::string& sentence) : std::runtime_error(sentence), status_(status) {}
  int status() const { return status_; }  // of the process, if it serves this session only

 private:
  int status_;
};

constexpr int kMalformedStatus = 1;        // for input on which the classic server crashes
constexpr int kUnknownActionStatus = 255;  // as in the classic server

struct ClassicOptions {
  bool run_length = true;  // whether screens are written in run lengths
  int max_num_frames = 0;  // frames since the start after which DIE is sent; 0: no limit
  // Called before each frame of an act, even if it is skipped, to record the screen. Empty: nothing is
  // recorded.
  std::function<void(const Environment&)> record = {};
};

// Enough to save at each action of an episode of 18,000 frames with a frame skip of 5; see
// protocol/CLASSIC.md.
constexpr std::size_t kMaxClassicStates = 4096;

class ClassicSession {
 public:
  ClassicSession(Environment& environment, const ClassicOptions& options);

  // Returns the next text to send, or nothing if more input is needed first. The text is valid until the next
  // call. Throws ClassicError.
  std::optional<std::string_view> reply();
  bool ended() const { return stage_ == Stage::kEnded; }  // after the last text of reply() is sent

  std::size_t saved_states() const { return saved_.size(); }
  void forget_oldest_state() { saved_.pop_front(); }  // there must be one

  int take_frames() { return std::exchange(frames_, 0); }  // frames that were run since the last call

  std::span<char> space() { return input_.space(); }  // where input goes
  void received(std::size_t count);  // this many bytes were added; 0: the client has closed its end

 private:
  enum class Stage { kDimensions, kFlags, kPlaying, kEnded };

  std::string_view dimensions();
  std::string_view answer(std::string_view line);
  std::string_view last_words();  // at the end of input
  void take_flags(std::string_view line);
  void take_action(std::string_view line);
  void act(int a, int b);
  int recorded_act(int a, int b);
  void save_state();
  void load_state();
  std::string_view data_line();
  std::string_view die();

  Environment& environment_;
  ClassicOptions options_;
  bool paddles_;
  LineBuffer input_;
  bool input_closed_ = false;
  Stage stage_ = Stage::kDimensions;
  bool send_screen_ = false, send_ram_ = false, send_episode_ = false;
  int reward_ = 0;  // of the last action
  int frames_ = 0;  // see take_frames()
  std::deque<std::shared_ptr<const Environment::Saved>> saved_;
  std::string text_;  // the last reply; kept for its memory
};

}  // namespace racebeam
