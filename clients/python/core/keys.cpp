#include "clients/python/core/keys.hpp"

#include <atomic>
#include <chrono>
#include <limits>

#include "system/invalid_input.hpp"

namespace racebeam::python {
namespace {

// Draws a seed. Two calls at the same time get different ones.
std::uint32_t seed_of_clock() {
  static std::atomic<std::uint32_t> calls{0};
  const auto now = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  return static_cast<std::uint32_t>(now ^ (now >> 32)) + calls.fetch_add(0x9E3779B9);
}

Rules rules_of(const std::string& name) {
  if (name == "ale-0.12") return Rules::kAle012;
  if (name == "fixed") return Rules::kFixed;
  throw InvalidInput("rules is '" + name + "'; it takes ale-0.12 or fixed");
}

void refuse_recording(const std::string& key, const std::string& value) {
  if (!value.empty())
    throw InvalidInput(key + " is '" + value +
                       "'; racebeam does not record by this key, so it takes only ''");
}

}  // namespace

Keys::Keys()
    : ints{{"frame_skip", 1},
           {"max_num_frames", 0},
           {"max_num_frames_per_episode", 0},
           {"paddle_max", -1},
           {"paddle_min", -1},
           {"random_seed", -1},
           {"reward_max", std::numeric_limits<int>::max()},
           {"reward_min", std::numeric_limits<int>::min()},
           {"system_random_seed", 4753849},
           {"freq", 31400},
           {"tiafreq", 31400},
           {"volume", 100},
           {"fragsize", 64},
           {"height", -1},
           {"ystart", -1}},
      bools{{"color_averaging", false},
            {"display_screen", false},
            {"restricted_action_set", false},
            {"run_length_encoding", true},
            {"send_rgb", false},
            {"sound", false},
            {"sound_obs", false},
            {"all_audio", false},
            {"truncate_on_loss_of_life", false},
            {"clipvol", true},
            {"unknown_images", false}},
      floats{{"repeat_action_probability", 0.25F}},
      strings{{"cpu", "low"},
              {"palette", "standard"},
              {"record_screen_dir", ""},
              {"record_sound_filename", ""},
              {"rom_file", ""},
              {"rules", "ale-0.12"},
              {"game_file", ""},
              {"scheme", ""},
              {"left", ""},
              {"right", ""},
              {"format", ""}} {}

Settings Keys::settings() const {
  for (const char* const key : {"record_screen_dir", "record_sound_filename"})
    refuse_recording(key, strings.at(key));
  Settings settings;
  const int seed = ints.at("random_seed");
  settings.rules = rules_of(strings.at("rules"));
  settings.random_seed = seed == -1 ? seed_of_clock() : static_cast<std::uint32_t>(seed);
  settings.system_seed = static_cast<std::uint32_t>(ints.at("system_random_seed"));
  settings.frame_skip = ints.at("frame_skip");
  settings.sticky = floats.at("repeat_action_probability");
  settings.max_episode_frames = ints.at("max_num_frames_per_episode");
  settings.truncate_on_life_loss = bools.at("truncate_on_loss_of_life");
  settings.reward_min = ints.at("reward_min");
  settings.reward_max = ints.at("reward_max");
  settings.color_averaging = bools.at("color_averaging");
  settings.sound = bools.at("sound_obs");
  settings.paddle_min = ints.at("paddle_min");
  settings.paddle_max = ints.at("paddle_max");
  return settings;
}

PropertyOverrides Keys::console() const {
  PropertyOverrides console;
  for (const char* const key : {"scheme", "left", "right", "format"})
    if (const std::string& value = strings.at(key); !value.empty()) console.set(key, value);
  for (const char* const key : {"ystart", "height"})
    if (const int value = ints.at(key); value != -1) console.set(key, std::to_string(value));
  return console;
}

}  // namespace racebeam::python
