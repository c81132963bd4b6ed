// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
// clang-format off
#pragma once

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

struct EvaluationPreset {
  std::string_view name, words;
};

inline constexpr std::array<Setting, 24> kSettings = {{
    {"preset", "none or a preset's name", "a set of settings from the literature; other keys override it", false},
    {"seed", "random, or 1 to 4294967295", "seed of everything that is random in play; random: the server chooses one", false},
    {"system_seed", "0 to 4294967295", "seed of the memory's contents at power-on", false},
    {"frame_skip", "1 to 1000, or a range such as 2-4", "frames of an act; with a range, each act draws its number from it", false},
    {"sticky", "0 to 1", "probability that a frame repeats the previous action", false},
    {"mode", "see `modes`", "variation of the game", false},
    {"difficulty", "see `difficulties`", "difficulty switches", false},
    {"max_episode_frames", "0 to 2147483647", "frames after which an episode is truncated; 0: never", false},
    {"life_loss", "ignored, reported, end or restart", "what a lost life does", false},
    {"life_loss_ends", "0 or 1", "1: as life_loss=restart, but the episode is truncated (deprecated: use life_loss)", true},
    {"noop_max", "0 to 1000", "an episode begins with 0 to noop_max - 1 frames of NOOP, drawn by seed", false},
    {"autoreset", "disabled, next-step or same-step", "what happens at the end of an episode", false},
    {"action_set", "full, legal, minimal or console", "the actions that `act` accepts", false},
    {"reward_min", "none or a whole number", "an act's reward is clamped to at least this", false},
    {"reward_max", "none or a whole number", "an act's reward is clamped to at most this", false},
    {"rules", "ale-0.12 or fixed", "rules of score and end: those of the reference, or corrected ones", false},
    {"color_averaging", "0 or 1", "blend each screen with the one before it", false},
    {"sound", "0 or 1", "generate the samples of the field audio", false},
    {"scheme", "auto or a scheme's name, with _ for a blank", "how the cartridge switches its banks; auto detects it", false},
    {"left", "joystick, paddles, keyboard, driving, booster, genesis, light_gun, trackball, atari_mouse, amiga_mouse, savekey or none", "controller in the left port", false},
    {"right", "joystick, paddles, keyboard, driving, booster, genesis, light_gun, trackball, atari_mouse, amiga_mouse, savekey or none", "controller in the right port", false},
    {"format", "auto, ntsc, pal, pal60 or secam", "television standard; auto detects it", false},
    {"ystart", "0 to 50", "first line of the picture", false},
    {"height", "100 to 256", "lines of the picture, 200 at least; with PAL and SECAM, 210 means 250", false},
}};

inline constexpr std::array<Preset, 4> kPresets = {{
    {"paper2013", "frame_skip=5 sticky=0 action_set=full max_episode_frames=18000", "Bellemare et al. 2013"},
    {"dqn2015", "frame_skip=4 sticky=0 action_set=minimal max_episode_frames=18000 life_loss=restart noop_max=30 reward_min=-1 reward_max=1", "Mnih et al. 2015, as in training; evaluate with life_loss=ignored and unclamped rewards"},
    {"machado2018", "frame_skip=5 sticky=0.25 action_set=full max_episode_frames=18000", "Machado et al. 2018"},
    {"gym-v5", "frame_skip=4 sticky=0.25 action_set=minimal max_episode_frames=108000", "Gymnasium's ALE/...-v5"},
}};

inline constexpr std::array<EvaluationPreset, 4> kEvaluationPresets = {{
    {"paper2013", "frame_skip=5 sticky=0 action_set=full max_episode_frames=18000 noop_max=0"},
    {"machado2018", "frame_skip=5 sticky=0.25 action_set=full max_episode_frames=18000 noop_max=0"},
    {"atari100k", "frame_skip=4 sticky=0 action_set=minimal max_episode_frames=108000 noop_max=30"},
    {"dqn2015", "frame_skip=4 sticky=0 action_set=minimal max_episode_frames=18000 noop_max=30"},
}};

}  // namespace racebeam::description
