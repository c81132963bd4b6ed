#include "protocol/classic/classic.hpp"

#include <algorithm>
#include <array>

#include "environment/input/has_paddles.hpp"
#include "protocol/encoding/text.hpp"

namespace racebeam {
namespace {

// The classic server reads at most this much of a line at once; it takes a longer line as two.
constexpr std::size_t kLongestFlags = 1023, kLongestAction = 2047;

constexpr float kStrength = 1;  // how far a paddle turns

// What player A can request besides the 18 actions.
enum Special { kSaveState = 43, kLoadState = 44, kSystemReset = 45 };

bool is_player_a(int a) { return a >= 0 && a < kActions; }
bool is_player_b(int b) { return b >= kActions && b < 2 * kActions; }

void require(std::size_t found, std::size_t needed, const std::string& line) {
  if (found == needed) return;
  throw ClassicError(kMalformedStatus, "the client sent " + std::to_string(found) + " numbers where " + line +
                                           " was expected; the session is over");
}

}  // namespace

ClassicSession::ClassicSession(Environment& environment, const ClassicOptions& options)
    : environment_(environment), options_(options), paddles_(has_paddles(environment)) {}

void ClassicSession::received(std::size_t count) {
  input_.added(count);
  input_closed_ = count == 0;
}

std::optional<std::string_view> ClassicSession::reply() {
  if (stage_ == Stage::kDimensions) return dimensions();
  const std::size_t longest = stage_ == Stage::kFlags ? kLongestFlags : kLongestAction;
  if (const auto line = input_.line(longest)) return answer(*line);
  if (input_closed_) return last_words();
  return std::nullopt;
}

std::string_view ClassicSession::dimensions() {
  stage_ = Stage::kFlags;
  text_ = std::to_string(kScreenWidth) + "-" + std::to_string(environment_.height()) + "\n";
  return text_;
}

std::string_view ClassicSession::answer(std::string_view line) {
  if (stage_ == Stage::kFlags) {
    take_flags(line);
  } else {
    take_action(line);
  }
  return data_line();
}

// A last line without LF is executed, but its reply is not sent. The classic server then runs one more act,
// which only a recording shows.
std::string_view ClassicSession::last_words() {
  if (!input_.rest().empty()) answer(input_.rest());
  if (options_.record) recorded_act(0, kActions);
  return die();
}

// The flags: screen, RAM, an old frame skip that is ignored, episode.
void ClassicSession::take_flags(std::string_view line) {
  std::array<int, 4> flags{};
  require(parse_integers(line, flags), flags.size(), "a line of four flags, such as 1,1,0,1,");
  send_screen_ = flags[0] != 0;
  send_ram_ = flags[1] != 0;
  send_episode_ = flags[3] != 0;
  stage_ = Stage::kPlaying;
}

void ClassicSession::take_action(std::string_view line) {
  std::array<int, 2> actions{};
  require(parse_integers(line, actions), actions.size(), "a line of two actions, such as 3,18,");
  const auto [a, b] = actions;
  reward_ = 0;
  switch (a) {
    case kSaveState: save_state(); break;
    case kLoadState: load_state(); break;
    case kSystemReset: environment_.reset_game(); break;
    default: act(a, b);
  }
}

// A number that is not an action presses nothing where the classic server accepted it: with paddles, and
// after the end. Player B's is never refused, because old clients send 0 or 45 there for "nothing". Both
// paddles turn with full strength.
void ClassicSession::act(int a, int b) {
  const bool accepted = is_player_a(a) || a == kReferenceReset || paddles_ || environment_.game_over();
  if (!accepted) {
    throw ClassicError(kUnknownActionStatus,
                       "the client asked for action " + std::to_string(a) +
                           "; accepted: 0-17, 40 (nothing), 43 (save), 44 (load) and 45 (reset)");
  }
  const int before = environment_.frame_number();
  reward_ = recorded_act(is_player_a(a) ? a : 0, is_player_b(b) ? b : kActions);
  frames_ += environment_.frame_number() - before;
}

// The screen is recorded before each frame of the act, and again for frames that are skipped because the
// episode has ended.
int ClassicSession::recorded_act(int a, int b) {
  if (!options_.record) return environment_.act(a, b, kStrength, kStrength);
  int missing = std::max(environment_.settings().frame_skip, 1);
  const auto record = [&] {
    if (missing-- > 0) options_.record(environment_);
  };
  record();
  environment_.watch(record);
  const int reward = environment_.act(a, b, kStrength, kStrength);
  environment_.watch(nullptr);
  while (missing > 0) record();
  return reward;
}

// A stack: the newest states are kept.
void ClassicSession::save_state() {
  if (saved_.size() == kMaxClassicStates) saved_.pop_front();
  saved_.push_back(environment_.save_without_pictures());
}

void ClassicSession::load_state() {
  if (saved_.empty()) {
    throw ClassicError(kMalformedStatus,
                       "the client loads a state (44), but none that it saved (43) is left; the newest " +
                           std::to_string(kMaxClassicStates) + " are kept");
  }
  environment_.restore_classic(*saved_.back());
  saved_.pop_back();
}

std::string_view ClassicSession::data_line() {
  if (options_.max_num_frames > 0 && environment_.frame_number() >= options_.max_num_frames) return die();
  text_.clear();
  if (send_ram_) {
    append_hex(text_, environment_.ram());
    text_ += ':';
  }
  if (send_screen_) {
    const auto screen = environment_.screen();
    options_.run_length ? append_run_length(text_, screen) : append_hex(text_, screen);
    text_ += ':';
  }
  if (send_episode_) text_ += (environment_.game_over() ? "1," : "0,") + std::to_string(reward_) + ':';
  text_ += '\n';
  return text_;
}

std::string_view ClassicSession::die() {
  stage_ = Stage::kEnded;
  return "DIE\n";
}

}  // namespace racebeam
