// What a client can set when it loads a game: one table, from which the settings are read, echoed and
// explained.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "environment/environment.hpp"
#include "environment/input/action_set.hpp"
#include "environment/vector/vector_environment.hpp"
#include "games/game/property_overrides.hpp"
#include "system/words.hpp"

namespace racebeam {

constexpr int kMaxFrameSkip = 1000;  // an act is never interrupted

struct PlaySettings {
  PlaySettings();  // the defaults of the line protocol

  Settings machine;
  std::optional<int> mode, difficulty;  // the game's defaults if not given
  PropertyOverrides console;
  ActionSet action_set = ActionSet::kFull;
  Autoreset autoreset = Autoreset::kDisabled;
  LifeLoss life_loss = LifeLoss::kIgnored;  // kRestart also sets machine.truncate_on_life_loss
  int noop_max = 0;                         // an episode begins with 0 to noop_max - 1 frames of NOOP
  std::string_view preset = "none";
};

struct SettingRow {
  std::string_view name;
  std::string_view accepted;  // for people
  bool is_deprecated;
  std::string_view summary;
  void (*set)(PlaySettings& settings, std::string_view value);  // throws InvalidInput
  // Null if the replies have the key anyway.
  void (*append)(std::string& out, const PlaySettings& settings, const Environment& machine);
};
std::span<const SettingRow> setting_rows();

struct PresetRow {
  std::string_view name;
  std::string_view words;  // the settings that a client could have written instead
  std::string_view source;
};
std::span<const PresetRow> preset_rows();

// Reads the words key=value of a request; a preset is applied first, wherever it is. Throws InvalidArguments,
// which lists `other_keys` with the settings: those that the request may have beside them.
void read_settings(Words words, PlaySettings& settings, Words other_keys = {});

// " key=value" for every setting, as it is in effect.
void append_settings(std::string& out, const PlaySettings& settings, const Environment& machine);

std::string_view name_of(ActionSet set);
std::string_view name_of(Autoreset autoreset);
Autoreset autoreset_of(std::string_view name);  // throws InvalidInput
LifeLoss life_loss_of(std::string_view name);   // throws InvalidInput
void set_life_loss(PlaySettings& settings, LifeLoss life_loss);
bool truncates_on_life_loss(const PlaySettings& settings);  // as the old setting life_loss_ends requests
std::uint32_t parse_seed(std::string_view text);            // throws InvalidInput

}  // namespace racebeam
