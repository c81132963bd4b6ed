// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
// clang-format off
#pragma once

#include <array>
#include <string_view>

namespace racebeam::description {

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

inline constexpr std::array<Field, 23> kFields = {{
    {"reward", "sum of the rewards of the request's acts, each clamped as loaded", true, ""},
    {"reward_b", "sum of player B's rewards, each clamped as loaded", true, ""},
    {"raw_reward", "sum of the rewards before clamping", true, ""},
    {"raw_reward_b", "sum of player B's rewards before clamping", true, ""},
    {"terminated", "1: the game is over, or a lost life counts as its end (life_loss)", true, ""},
    {"truncated", "1: the limit of frames ended the episode", true, ""},
    {"game_over", "1: the game itself is over; lost lives and limits do not count", true, ""},
    {"lives", "remaining lives; 0 in games without lives", false, ""},
    {"frame", "frames since power-on: since load, or since reset or restart with a seed", false, ""},
    {"episode_frame", "frames since the episode began", false, ""},
    {"acts", "acts that the request played; fewer than it asked for if the episode ended", true, ""},
    {"frames", "frames that the request ran", true, ""},
    {"ram", "128 bytes", false, "hex"},
    {"tia", "53 bytes: the registers of the TIA and its collision latches; names has their names", false, "hex"},
    {"state_hash", "8 bytes: a hash of the machine's state, without pictures, sound, counters and generators", false, "hex"},
    {"screen", "height x 160 palette indices, row by row", false, "rle"},
    {"rgb", "height x 160 x 3: red, green and blue of each pixel", false, "zlib"},
    {"grey", "height x 160: the grey of each pixel", false, "zlib"},
    {"greyWxHxN", "a stack of N screens, W x H, grey, each the brighter of two frames, oldest first, such as grey84x84x4", false, "zlib"},
    {"rgbWxHxN", "a stack of N screens, W x H, in colour: red, green and blue of each pixel; otherwise like greyWxHxN", false, "zlib"},
    {"palette", "256 x 3: red, green and blue of each value of screen", false, "hex"},
    {"audio", "512 samples of the last act; requires sound=1", false, "hex"},
    {"audio_all", "512 samples for each frame that the request ran; requires sound=1, and observe instead of look", false, "hex"},
}};

inline constexpr std::array<Choice, 24> kChoices = {{
    {"life_loss", "ignored", "a lost life has no effect"},
    {"life_loss", "reported", "the act or step that loses a life is `terminated`; the episode continues"},
    {"life_loss", "end", "a lost life ends the episode, `terminated`; the next one continues with the next life, as in DQN"},
    {"life_loss", "restart", "a lost life ends the episode, `terminated`; the next one is a new game"},
    {"autoreset", "disabled", "the machine does not change, and `act` or `step` answers `over=1`, until `reset` or `restart`"},
    {"autoreset", "next-step", "the next act or step resets the machine and ignores the action: reward 0, both ends 0"},
    {"autoreset", "same-step", "the act or step that ends an episode also resets the machine"},
    {"action_set", "full", "the 18 actions of a joystick"},
    {"action_set", "legal", "the actions of a joystick that the game does not ignore"},
    {"action_set", "minimal", "the actions of a joystick that have an effect in the game"},
    {"action_set", "console", "the 18 actions of a joystick, those of the console's switches, and those of other controllers"},
    {"steps", "acts", "a step is one act, as `act` plays it"},
    {"steps", "frames", "a step is `frame_skip` frames, as in ALE's vector environment"},
    {"start", "fire-noops", "an episode begins with a frame of FIRE, if the action set has it, and the no-ops of `noop_max`, less one for FIRE"},
    {"start", "noops-fire", "as in EnvPool: the no-ops, then FIRE; one no-op more if the set has no FIRE"},
    {"start", "baselines", "as in Stable-Baselines3: 1 to `noop_max` no-ops, then a step of FIRE and one of the set's next action"},
    {"start", "noops", "only the no-ops"},
    {"stack", "zeros", "a stack begins with zeros"},
    {"stack", "repeats", "a stack begins with copies of the first screen, and is kept when the next life continues the game"},
    {"pool", "1", "each screen of a stack is the brighter of a step's last two frames"},
    {"pool", "0", "each screen of a stack is the last frame"},
    {"role", "learner", "it was trained"},
    {"role", "planner", "it searches in the emulator"},
    {"role", "baseline", "neither"},
}};

inline constexpr std::array<OldWord, 14> kOldWords = {{
    {"load", "seed=0", "seed=random", true},
    {"load", "life_loss_ends", "life_loss", false},
    {"load", "autoreset=0", "autoreset=disabled", true},
    {"load", "autoreset=1", "autoreset=next-step", true},
    {"save", "random", "generator", true},
    {"export", "whole", "episode", true},
    {"open", "autoreset=0", "autoreset=disabled", true},
    {"open", "autoreset=1", "autoreset=next-step", true},
    {"open", "lives=told", "life_loss=reported", true},
    {"open", "lives", "life_loss", true},
    {"open", "life_loss=told", "life_loss=reported", true},
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

inline constexpr std::array<std::string_view, 26> kActions = {{
    "NOOP",
    "FIRE",
    "UP",
    "RIGHT",
    "LEFT",
    "DOWN",
    "UPRIGHT",
    "UPLEFT",
    "DOWNRIGHT",
    "DOWNLEFT",
    "UPFIRE",
    "RIGHTFIRE",
    "LEFTFIRE",
    "DOWNFIRE",
    "UPRIGHTFIRE",
    "UPLEFTFIRE",
    "DOWNRIGHTFIRE",
    "DOWNLEFTFIRE",
    "RESET",
    "SELECT",
    "LEFT_A",
    "LEFT_B",
    "RIGHT_A",
    "RIGHT_B",
    "COLOR",
    "BW",
}};

inline constexpr std::array<std::string_view, 80> kReplyKeys = {{
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
    "log",
    "log_ended",
    "logged",
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
    "row",
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
    "unit",
    "unlogged",
    "watchers",
    "width",
}};

inline constexpr std::array<Error, 21> kErrors = {{
    {"bad-line", "the line is empty, or has a byte that is not printable ASCII"},
    {"line-too-long", "the line is longer than `hello` allows"},
    {"half-line", "the input ended within a line, which was not executed"},
    {"unknown-command", "the command is unknown"},
    {"bad-arguments", "there are too few or too many arguments, or a key or a field is unknown"},
    {"bad-value", "a number or a word is not accepted"},
    {"bad-action", "the action is unknown, or not in the set that was loaded"},
    {"unknown-game", "the game is unknown: no image has that name or MD5"},
    {"bad-image", "the bytes that were sent are not a cartridge image"},
    {"no-game", "the command needs a game: `load` first"},
    {"no-machines", "the command needs machines: `open` first"},
    {"no-state", "no state of that name was saved"},
    {"bad-state", "the bytes that were sent are not a state of this game"},
    {"recording", "the server does not record, a recording is running, nothing is being recorded, or the files cannot be written"},
    {"no-log", "the server writes no logs, episodes are already being logged, or are not, or this episode or game cannot have a log"},
    {"limit", "the request asks for more than `hello` allows, or than the server has memory for"},
    {"unauthorized", "this server requires a token: `hello token=TOKEN`"},
    {"busy", "the server has reached its limit of sessions or of memory; it closes this session"},
    {"idle", "nothing was received or sent for too long; the server closes the session"},
    {"stopping", "the server is stopping; it closes the session"},
    {"internal", "an internal error of the server; the request may be partly executed"},
}};

}  // namespace racebeam::description
