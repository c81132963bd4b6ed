// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
// clang-format off
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace racebeam::description {

struct Setting {
  std::string_view name, accepted, summary;
  bool is_deprecated;
};

struct Preset {
  std::string_view name, words, source;
};

struct Field {
  std::string_view name, summary;
  bool of_request;
  std::string_view encoding;  // of bytes; empty: a number
};

struct Choice {  // a value that a key of a command, or a setting, may have
  std::string_view key, value, meaning;
};

// A word of a request that has a new name: a key, a pair KEY=VALUE or a field.
struct OldWord {
  std::string_view of;  // the command, or "field"
  std::string_view old, now;
  bool is_same;  // the server takes the one for the other
};

struct Encoding {
  std::string_view name, summary;
};

struct Error {
  std::string_view name, meaning;
};

// The row of this name. Without it, the program does not compile.
template <typename Rows>
consteval const auto& row_named(const Rows& rows, std::string_view name) {
  for (const auto& row : rows)
    if (row.name == name) return row;
  throw "there is no row of this name";
}

// Whether two tables have the same names, in the same order.
template <typename One, typename Other>
consteval bool same_names(const One& one, const Other& other) {
  return std::ranges::equal(one, other, [](const auto& a, const auto& b) { return a.name == b.name; });
}

inline constexpr std::array<Setting, 24> kSettings = {{
    {"preset", "none or a preset's name", "a set of settings from the literature; other keys override it", false},
    {"seed", "random, or 1 to 4294967295", "seed of everything that is random in play; random: the server chooses one", false},
    {"system_seed", "0 to 4294967295", "seed of the memory's contents at power-on", false},
    {"frame_skip", "1 to 1000, or a range such as 2-4", "frames of an act; with a range, each act draws its number from it", false},
    {"sticky", "0 to 1", "probability that a frame repeats the previous action", false},
    {"mode", "see `modes`", "variation of the game", false},
    {"difficulty", "see `difficulties`", "difficulty switches", false},
    {"max_episode_frames", "0 to 2147483647", "frames after which an episode is truncated; 0: never", false},
    {"life_loss", "ignored, told, end or restart", "what a lost life does", false},
    {"life_loss_ends", "0 or 1", "1: as life_loss=restart, but the episode is truncated (deprecated: use life_loss)", true},
    {"noop_max", "0 to 1000", "an episode begins with 0 to noop_max - 1 frames of NOOP, drawn by seed", false},
    {"autoreset", "disabled, next-step or same-step", "what happens at the end of an episode", false},
    {"action_set", "full, legal or minimal", "the actions that `act` accepts", false},
    {"reward_min", "none or a whole number", "an act's reward is clamped to at least this", false},
    {"reward_max", "none or a whole number", "an act's reward is clamped to at most this", false},
    {"rules", "ale-0.12 or fixed", "rules of score and end: those of the reference, or corrected ones", false},
    {"color_averaging", "0 or 1", "blend each screen with the one before it", false},
    {"sound", "0 or 1", "generate the samples of the field audio", false},
    {"scheme", "auto or a scheme's name, with _ for a blank", "how the cartridge switches its banks, where auto detects it", false},
    {"left", "joystick or paddles", "controller in the left port", false},
    {"right", "joystick or paddles", "controller in the right port", false},
    {"format", "auto, ntsc, pal, pal60 or secam", "television standard, where auto detects it", false},
    {"ystart", "0 to 50", "first line of the picture", false},
    {"height", "100 to 256", "lines of the picture, 200 at least; PAL and SECAM make 250 of 210", false},
}};

inline constexpr std::array<Preset, 4> kPresets = {{
    {"paper2013", "frame_skip=5 sticky=0 action_set=full max_episode_frames=18000", "Bellemare et al. 2013"},
    {"dqn2015", "frame_skip=4 sticky=0 action_set=minimal max_episode_frames=18000 life_loss=restart noop_max=30 reward_min=-1 reward_max=1", "Mnih et al. 2015, as in training; evaluate with life_loss=ignored and unclamped rewards"},
    {"machado2018", "frame_skip=5 sticky=0.25 action_set=full max_episode_frames=18000", "Machado et al. 2018"},
    {"gym-v5", "frame_skip=4 sticky=0.25 action_set=minimal max_episode_frames=108000", "Gymnasium's ALE/...-v5"},
}};

inline constexpr std::array<Field, 21> kFields = {{
    {"reward", "sum over the acts of the request; each act's reward is clamped as loaded", true, ""},
    {"reward_b", "the same for player B", true, ""},
    {"raw_reward", "the same before clamping", true, ""},
    {"raw_reward_b", "the same for player B", true, ""},
    {"terminated", "1: the game is over, or a lost life counts as its end (life_loss)", true, ""},
    {"truncated", "1: the episode was cut short, by the limit of frames", true, ""},
    {"game_over", "1: the game itself is over; lost lives and limits do not count", true, ""},
    {"lives", "remaining lives; 0 in games without lives", false, ""},
    {"frame", "frames since the game was loaded", false, ""},
    {"episode_frame", "frames since the episode began", false, ""},
    {"acts", "acts that were played; fewer than requested if the episode ended", true, ""},
    {"frames", "frames that the request ran", true, ""},
    {"ram", "128 bytes", false, "hex"},
    {"tia", "53 bytes: the registers of the TIA and its collision latches; names has their names", false, "hex"},
    {"screen", "height x 160 palette indices, row by row", false, "rle"},
    {"rgb", "height x 160 x 3: red, green, blue", false, "zlib"},
    {"grey", "height x 160", false, "zlib"},
    {"greyWxHxN", "a stack of N screens, W x H, grey, each the brighter of two frames, oldest first, such as grey84x84x4", false, "zlib"},
    {"rgbWxHxN", "the same in colour: red, green and blue of each pixel", false, "zlib"},
    {"palette", "256 x 3: red, green, blue of each value of screen", false, "hex"},
    {"audio", "512 samples of the last act; needs sound=1", false, "hex"},
}};

inline constexpr std::array<Choice, 17> kChoices = {{
    {"life_loss", "ignored", "a lost life has no effect"},
    {"life_loss", "told", "the act or step that loses a life is `terminated`; the episode continues"},
    {"life_loss", "end", "a lost life ends the episode, `terminated`; the next one continues with the next life, as in DQN"},
    {"life_loss", "restart", "a lost life ends the episode, `terminated`; the next one is a new game"},
    {"autoreset", "disabled", "the machine does not change, and `act` or `step` answers `over=1`, until `reset` or `restart`"},
    {"autoreset", "next-step", "the next act or step resets the machine and ignores the action: reward 0, both ends 0"},
    {"autoreset", "same-step", "the act or step that ends an episode also resets the machine"},
    {"steps", "acts", "a step is one act, as `act` plays it"},
    {"steps", "frames", "a step is `frame_skip` frames, as in ALE's vector environment"},
    {"start", "fire-noops", "an episode begins with a frame of FIRE, if the action set has it, and the no-ops of `noop_max`, less one for FIRE"},
    {"start", "noops-fire", "as in EnvPool: the no-ops, then FIRE; one no-op more if the set has no FIRE"},
    {"start", "baselines", "as in Stable-Baselines3: 1 to `noop_max` no-ops, then a step of FIRE and one of the set's next action"},
    {"start", "noops", "only the no-ops"},
    {"stack", "zeros", "a stack begins with zeros"},
    {"stack", "repeats", "it begins with copies of the first screen, and is kept when the next life continues the game"},
    {"pool", "1", "each screen of a stack is the brighter of a step's last two frames"},
    {"pool", "0", "each screen of a stack is the last frame"},
}};

inline constexpr std::array<OldWord, 12> kOldWords = {{
    {"load", "seed=0", "seed=random", true},
    {"load", "life_loss_ends", "life_loss", false},
    {"load", "autoreset=0", "autoreset=disabled", true},
    {"load", "autoreset=1", "autoreset=next-step", true},
    {"save", "random", "generator", true},
    {"export", "whole", "episode", true},
    {"open", "autoreset=0", "autoreset=disabled", true},
    {"open", "autoreset=1", "autoreset=next-step", true},
    {"open", "lives", "life_loss", true},
    {"field", "ends", "terminated truncated", true},
    {"field", "grey84", "grey84x84x1", true},
    {"field", "grey84xN", "grey84x84xN", true},
}};

inline constexpr std::array<Encoding, 6> kEncodings = {{
    {"hex", "two digits a byte, upper case"},
    {"rle", "runs: value and length, two digits each; the length is 01 to FF; runs continue across rows"},
    {"delta", "records of what changed since the last reply with this field"},
    {"base64", "RFC 4648, with padding"},
    {"zlib", "zlib (RFC 1950), then base64"},
    {"raw", "how many bytes; they follow the line of the reply, as they are"},
}};

inline constexpr std::array<std::string_view, 74> kReplyKeys = {{
    "action",
    "action_set",
    "actions",
    "acts",
    "admitted",
    "autoreset",
    "branches",
    "bytes",
    "bytes_in",
    "bytes_out",
    "complete",
    "count",
    "data",
    "default",
    "difficulties",
    "difficulty",
    "encodings",
    "episode",
    "episodes",
    "errors",
    "fields",
    "format",
    "fps",
    "frame",
    "frames",
    "game",
    "games",
    "height",
    "here",
    "image",
    "index",
    "left",
    "legal",
    "lives",
    "machines",
    "max_idle",
    "max_line",
    "max_machines",
    "max_reply",
    "max_request_frames",
    "max_states",
    "md5",
    "minimal",
    "mode",
    "modes",
    "name",
    "over",
    "picture",
    "presets",
    "protocol",
    "ram_names",
    "recorded",
    "recording",
    "recording_ended",
    "requests",
    "reward",
    "reward_b",
    "rewards",
    "rewards_b",
    "right",
    "rule",
    "scheme",
    "score",
    "server",
    "share",
    "state",
    "states",
    "terminated",
    "threads",
    "tia_names",
    "truncated",
    "two_player_modes",
    "watchers",
    "width",
}};

inline constexpr std::array<Error, 20> kErrors = {{
    {"bad-line", "the line is empty, or has a byte that is not printable ASCII"},
    {"line-too-long", "the line is longer than `hello` allows"},
    {"half-line", "the input ended within a line, which was not executed"},
    {"unknown-command", "there is no such command"},
    {"bad-arguments", "too few, too many, or no such key or field"},
    {"bad-value", "a number or a word is not accepted"},
    {"bad-action", "there is no such action, or it is not in the set that was loaded"},
    {"unknown-game", "there is no image of that name or MD5"},
    {"bad-image", "the bytes that were sent are not a cartridge image"},
    {"no-game", "the command needs a game: `load` first"},
    {"no-machines", "the command needs machines: `open` first"},
    {"no-state", "no state of that name was saved"},
    {"bad-state", "the bytes that were sent are not a state of this game"},
    {"recording", "recordings are off, one is running, or the files cannot be written"},
    {"limit", "more than `hello` allows, or than the server has memory for"},
    {"unauthorized", "this server requires a token: `hello token=TOKEN`"},
    {"busy", "the server has reached its limit of sessions or of memory; it closes this one"},
    {"idle", "nothing was received or sent for too long; the server closes the session"},
    {"stopping", "the server is stopping; it closes the session"},
    {"internal", "an internal error of the server; the request may be partly executed"},
}};

}  // namespace racebeam::description
