#include "protocol/classic/rl_glue.hpp"

#include <bit>
#include <stdexcept>

namespace racebeam {
namespace {

enum Type : std::uint32_t {
  kEnvironmentConnection = 3,
  kInit = 11,
  kStart = 12,
  kStep = 13,
  kCleanup = 14,
  kMessage = 19,
  kTerminate = 35
};

constexpr int kRows = 210;  // of the observation, whatever the game
constexpr int kPlayerBNoop = 18;
constexpr float kPaddleStrength = 1;  // how far a paddle turns

template <typename Unsigned>
void append_big_endian(std::string& out, Unsigned number) {
  for (int shift = 8 * (sizeof number - 1); shift >= 0; shift -= 8) out += static_cast<char>(number >> shift);
}

void append_int(std::string& out, std::int32_t number) {
  append_big_endian(out, static_cast<std::uint32_t>(number));
}
void append_double(std::string& out, double number) {
  append_big_endian(out, std::bit_cast<std::uint64_t>(number));
}

// `bytes` has at least four bytes from `at` on.
std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (const char byte : bytes.substr(at, 4)) number = number << 8 | static_cast<std::uint8_t>(byte);
  return number;
}

std::string message(std::uint32_t type, std::string_view payload) {
  std::string bytes;
  bytes.reserve(kRlGlueHeaderBytes + payload.size());
  append_big_endian(bytes, type);
  append_big_endian(bytes, static_cast<std::uint32_t>(payload.size()));
  return bytes.append(payload);
}

std::string text(std::string_view words) {
  std::string bytes;
  append_int(bytes, static_cast<std::int32_t>(words.size()));
  return bytes.append(words);
}

// The first whole number of an action: a structure of numbers of ints, doubles and chars, and then these.
std::int32_t first_int(std::string_view action) {
  constexpr std::size_t kCounts = 12;
  const bool has_one = action.size() >= kCounts + 4 && number_at(action, 0) > 0;
  if (!has_one) {
    throw std::invalid_argument("the RL-Glue core sent an action of " + std::to_string(action.size()) +
                                " bytes without a whole number; one is needed, the index of the action");
  }
  return static_cast<std::int32_t>(number_at(action, kCounts));
}

}  // namespace

RlGlueHeader rl_glue_header(std::string_view bytes) { return {number_at(bytes, 0), number_at(bytes, 4)}; }

std::string rl_glue_greeting() { return message(kEnvironmentConnection, ""); }

RlGlueEnvironment::RlGlueEnvironment(Environment& environment, const RlGlueOptions& options)
    : environment_(environment),
      options_(options),
      actions_(options.minimal_actions ? environment.game().minimal_actions : all_actions()) {
  if (environment.height() != kRows) {
    throw std::invalid_argument("the screen of " + environment.game().name + " has " +
                                std::to_string(environment.height()) + " rows; RL-Glue takes games with " +
                                std::to_string(kRows));
  }
}

std::optional<std::string> RlGlueEnvironment::answer(std::uint32_t type, std::string_view payload) {
  const bool limited = options_.max_num_frames > 0;
  if (type == kTerminate || (limited && environment_.frame_number() >= options_.max_num_frames))
    return std::nullopt;
  switch (type) {
    case kInit: return message(type, text(task()));
    case kStart: return message(type, start());
    case kStep: return message(type, step(payload));
    case kCleanup: return message(type, "");
    case kMessage: return message(type, payload);
    default:
      throw std::invalid_argument("the RL-Glue core sent a message of type " + std::to_string(type) +
                                  "; accepted: 11 to 14, 19 and 35");
  }
}

// Byte for byte that of ALE 0.5 to 0.6.1: the bounds of actions and colours are wrong there, too.
std::string RlGlueEnvironment::task() const {
  return std::string(
             "VERSION RL-Glue-3.0 PROBLEMTYPE episodic DISCOUNTFACTOR 1 OBSERVATIONS INTS (128 0 255)") +
         (options_.rgb ? "(100800 0 255)" : "(33600 0 127)") + " ACTIONS INTS (0 " +
         std::to_string(actions_.size()) +
         ") REWARDS (UNSPEC UNSPEC) EXTRA Name: Arcade Learning Environment ";
}

std::string RlGlueEnvironment::start() {
  environment_.reset_game();
  return observation();
}

// The end is the game's own: an episode that reaches its limit of frames stands still.
std::string RlGlueEnvironment::step(std::string_view payload) {
  const std::int32_t index = first_int(payload);
  const bool is_known = index >= 0 && index < static_cast<std::int32_t>(actions_.size());
  const int action = actions_[is_known ? static_cast<std::size_t>(index) : 0];
  const int reward = environment_.act(action, kPlayerBNoop, kPaddleStrength, kPaddleStrength);
  std::string bytes;
  append_int(bytes, environment_.terminal() ? 1 : 0);
  append_double(bytes, reward);
  return bytes.append(observation());
}

std::string RlGlueEnvironment::observation() const {
  std::vector<std::uint8_t> colours;
  if (options_.rgb) environment_.screen_rgb(colours);
  const std::span<const std::uint8_t> screen =
      options_.rgb ? std::span<const std::uint8_t>(colours) : environment_.screen();
  std::string bytes;
  bytes.reserve(4 * (3 + kRamSize + screen.size()));
  append_int(bytes, static_cast<std::int32_t>(kRamSize + screen.size()));
  append_int(bytes, 0);  // doubles
  append_int(bytes, 0);  // chars
  for (const std::uint8_t byte : environment_.ram()) append_int(bytes, byte);
  for (const std::uint8_t pixel : screen) append_int(bytes, pixel);
  return bytes;
}

}  // namespace racebeam
