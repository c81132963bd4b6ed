#include "environment/settings/play_settings.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>

#include "emulator/cartridge/cartridge.hpp"
#include "environment/input/has_paddles.hpp"
#include "environment/settings/setting_tables.hpp"
#include "system/entropy.hpp"
#include "system/named_rows.hpp"

namespace racebeam {
namespace {

constexpr std::int64_t kMaxSeed = std::numeric_limits<std::uint32_t>::max();
constexpr std::int64_t kMaxNumber = std::numeric_limits<int>::max();
constexpr int kMinReward = std::numeric_limits<int>::min(), kMaxReward = std::numeric_limits<int>::max();
constexpr int kMaxNoops = 1000;
constexpr std::array<WordFor<ActionSet>, 4> kActionSets = {{{"full", ActionSet::kFull},
                                                            {"legal", ActionSet::kLegal},
                                                            {"minimal", ActionSet::kMinimal},
                                                            {"console", ActionSet::kConsole}}};
constexpr std::array<WordFor<Autoreset>, 3> kAutoresets = {{{"next-step", Autoreset::kNextStep},
                                                            {"same-step", Autoreset::kSameStep},
                                                            {"disabled", Autoreset::kDisabled}}};
// A reply has the numbers of version 0.1 where there is one.
constexpr std::array<WordFor<Autoreset>, 3> kShownAutoresets = {
    {{"1", Autoreset::kNextStep}, {"same-step", Autoreset::kSameStep}, {"0", Autoreset::kDisabled}}};
constexpr std::array<WordFor<LifeLoss>, 4> kLifeLosses = {{{"ignored", LifeLoss::kIgnored},
                                                           {"reported", LifeLoss::kReported},
                                                           {"end", LifeLoss::kEnd},
                                                           {"restart", LifeLoss::kRestart}}};
constexpr std::array<WordFor<Rules>, 2> kRules = {{{"ale-0.12", Rules::kAle012}, {"fixed", Rules::kFixed}}};

std::uint32_t fresh_seed() { return random_number() | 1U; }  // not 0

int whole(std::string_view value, std::string_view what, std::int64_t least, std::int64_t most) {
  return static_cast<int>(number_within(value, what, least, most));
}

bool flag(std::string_view value, std::string_view what) { return number_within(value, what, 0, 1) == 1; }

[[noreturn]] void refuse(std::string_view what, std::string_view value, std::string_view accepted) {
  throw InvalidInput(std::string(what) + " is " + quote(value) + "; it takes " + std::string(accepted));
}

void set_seed(PlaySettings& settings, std::string_view value) {
  settings.machine.random_seed = parse_seed(value);
}

void set_system_seed(PlaySettings& settings, std::string_view value) {
  settings.machine.system_seed = static_cast<std::uint32_t>(number_within(value, "system_seed", 0, kMaxSeed));
}

void set_frame_skip(PlaySettings& settings, std::string_view value) {
  const std::size_t dash = value.find('-', 1);  // one at the beginning is a sign
  settings.machine.frame_skip = whole(value.substr(0, dash), "frame_skip", 1, kMaxFrameSkip);
  settings.machine.frame_skip_max = dash == value.npos
                                        ? 0
                                        : whole(value.substr(dash + 1), "the end of frame_skip",
                                                settings.machine.frame_skip, kMaxFrameSkip);
}

void set_sticky(PlaySettings& settings, std::string_view value) {
  const auto probability = parse_number<float>(value);
  if (!probability || *probability < 0 || *probability > 1)
    refuse("sticky", value, "a probability from 0 to 1");
  settings.machine.sticky = std::abs(*probability);  // no -0
}

void set_action_set(PlaySettings& settings, std::string_view value) {
  settings.action_set = value_for(value, "action_set", kActionSets);
}

int reward_limit(std::string_view value, std::string_view what, int none) {
  return value == "none" ? none : whole(value, what, kMinReward, kMaxReward);
}

void set_rules(PlaySettings& settings, std::string_view value) {
  settings.machine.rules = value_for(value, "rules", kRules);
}

// The old setting, whose episodes are truncated.
void set_life_loss_ends(PlaySettings& settings, std::string_view value) {
  settings.life_loss = LifeLoss::kIgnored;
  settings.machine.truncate_on_life_loss = flag(value, "life_loss_ends");
}

void append_autoreset(std::string& out, const PlaySettings& settings, const Environment&) {
  out += word_for(kShownAutoresets, settings.autoreset);
}

void set_preset(PlaySettings& settings, std::string_view value) {
  if (value == "none") return;
  auto names = names_of(preset_rows());
  names.push_back("none");
  const PresetRow* const found = &preset_rows()[choice_of(value, "preset", names)];
  std::vector<std::string_view> words;
  split(found->words, words);
  read_settings(words, settings);
  settings.preset = found->name;
}

void append_frame_skip(std::string& out, const PlaySettings& settings, const Environment&) {
  append_number(out, std::int64_t{settings.machine.frame_skip});
  if (settings.machine.frame_skip_max == 0) return;
  out += '-';
  append_number(out, std::int64_t{settings.machine.frame_skip_max});
}

void append_reward_limit(std::string& out, int limit, int none) {
  limit == none ? void(out += "none") : append_number(out, std::int64_t{limit});
}

// A short way to write the two functions of a row whose value is a number.
#define READ(expression) [](PlaySettings& s, std::string_view value) { expression; }
#define ECHO(expression)                                                               \
  [](std::string& out, [[maybe_unused]] const PlaySettings& s, const Environment& e) { \
    (void)e;                                                                           \
    append_number(out, expression);                                                    \
  }

using Set = void (*)(PlaySettings& settings, std::string_view value);
using Append = void (*)(std::string& out, const PlaySettings& settings, const Environment& machine);

constexpr SettingRow setting(std::string_view name, Set set, Append append) {
  const description::Setting& row = row_named(description::kSettings, name);
  return {name, row.accepted, row.is_deprecated, row.summary, set, append};
}

constexpr std::array kSettings = {
    setting("preset", set_preset,
            [](std::string& out, const PlaySettings& s, const Environment&) { out += s.preset; }),
    setting("seed", set_seed, ECHO(std::int64_t{e.settings().random_seed})),
    setting("system_seed", set_system_seed, ECHO(std::int64_t{s.machine.system_seed})),
    setting("frame_skip", set_frame_skip, append_frame_skip),
    setting("sticky", set_sticky,
            [](std::string& out, const PlaySettings& s, const Environment&) {
              std::array<char, 32> digits;
              out.append(digits.data(),
                         std::to_chars(digits.data(), digits.data() + digits.size(), s.machine.sticky).ptr);
            }),
    setting("mode", READ(s.mode = whole(value, "mode", 0, kMaxNumber)), ECHO(std::int64_t{e.mode()})),
    setting("difficulty", READ(s.difficulty = whole(value, "difficulty", 0, kMaxNumber)),
            ECHO(std::int64_t{e.difficulty()})),
    setting("max_episode_frames",
            READ(s.machine.max_episode_frames = whole(value, "max_episode_frames", 0, kMaxNumber)),
            ECHO(std::int64_t{s.machine.max_episode_frames})),
    setting("life_loss", READ(set_life_loss(s, life_loss_of(value))),
            [](std::string& out, const PlaySettings& s, const Environment&) {
              out += word_for(kLifeLosses, s.life_loss);
            }),
    setting("life_loss_ends", set_life_loss_ends,
            ECHO(std::int64_t{truncates_on_life_loss(s) || s.life_loss >= LifeLoss::kEnd})),
    setting("noop_max", READ(s.noop_max = whole(value, "noop_max", 0, kMaxNoops)),
            ECHO(std::int64_t{s.noop_max})),
    setting("autoreset", READ(s.autoreset = autoreset_of(value)), append_autoreset),
    setting(
        "action_set", set_action_set,
        [](std::string& out, const PlaySettings& s, const Environment&) { out += name_of(s.action_set); }),
    setting("reward_min", READ(s.machine.reward_min = reward_limit(value, "reward_min", kMinReward)),
            [](std::string& out, const PlaySettings& s, const Environment&) {
              append_reward_limit(out, s.machine.reward_min, kMinReward);
            }),
    setting("reward_max", READ(s.machine.reward_max = reward_limit(value, "reward_max", kMaxReward)),
            [](std::string& out, const PlaySettings& s, const Environment&) {
              append_reward_limit(out, s.machine.reward_max, kMaxReward);
            }),
    setting("rules", set_rules,
            [](std::string& out, const PlaySettings& s, const Environment&) {
              out += word_for(kRules, s.machine.rules);
            }),
    setting("color_averaging", READ(s.machine.color_averaging = flag(value, "color_averaging")),
            ECHO(std::int64_t{s.machine.color_averaging})),
    setting("sound", READ(s.machine.sound = flag(value, "sound")), ECHO(std::int64_t{s.machine.sound})),
    setting("scheme", READ(s.console.set("scheme", value)),
            [](std::string& out, const PlaySettings&, const Environment& e) {
              out += scheme_word(scheme_of(*e.image().bytes, properties_of(e).scheme).name);
            }),
    setting("left", READ(s.console.set("left", value)),
            [](std::string& out, const PlaySettings&, const Environment& e) {
              out += name_of(properties_of(e).left);
            }),
    setting("right", READ(s.console.set("right", value)),
            [](std::string& out, const PlaySettings&, const Environment& e) {
              out += name_of(properties_of(e).right);
            }),
    setting("format", READ(s.console.set("format", value)), nullptr),
    setting("ystart", READ(s.console.set("ystart", value)), ECHO(std::int64_t{properties_of(e).ystart})),
    setting("height", READ(s.console.set("height", value)), nullptr),
};

#undef READ
#undef ECHO

static_assert(same_names(kSettings, description::kSettings));

constexpr auto kPresets = [] {
  std::array<PresetRow, description::kPresets.size()> rows;
  std::ranges::transform(description::kPresets, rows.begin(), [](const description::Preset& row) {
    return PresetRow{row.name, row.words, row.source};
  });
  return rows;
}();

// In this order, so that a setting overrides its old word and both override a preset.
enum class Rank { kPreset, kOld, kOther };

Rank rank_of(std::string_view key) {
  if (key == "preset") return Rank::kPreset;
  const auto row = std::ranges::find(kSettings, key, &SettingRow::name);
  return row != kSettings.end() && row->is_deprecated ? Rank::kOld : Rank::kOther;
}

const SettingRow& setting_row(std::string_view name, Words other_keys) {
  const auto found = std::ranges::find(kSettings, name, &SettingRow::name);
  if (found != kSettings.end()) return *found;
  auto names = names_of(kSettings);
  names.insert(names.end(), other_keys.begin(), other_keys.end());
  refuse_name("setting", name, names);
}

}  // namespace

// Episodes have a limit, since one that never ends is useless. It is Gymnasium's.
PlaySettings::PlaySettings() { machine.max_episode_frames = 108000; }

std::span<const SettingRow> setting_rows() { return kSettings; }
std::span<const PresetRow> preset_rows() { return kPresets; }

void read_settings(Words words, PlaySettings& settings, Words other_keys) {
  std::bitset<kSettings.size()> present;
  for (const Rank rank : {Rank::kPreset, Rank::kOld, Rank::kOther}) {
    for (const std::string_view word : words) {
      const auto [key, value] = key_value(word);
      if (rank_of(key) != rank) continue;
      const SettingRow& row = setting_row(key, other_keys);
      const auto place = static_cast<std::size_t>(&row - kSettings.data());
      if (present[place]) refuse_twice(key);
      present.set(place);
      row.set(settings, value);
    }
  }
}

void append_settings(std::string& out, const PlaySettings& settings, const Environment& machine) {
  for (const SettingRow& row : kSettings) {
    if (!row.append) continue;
    ((out += ' ') += row.name) += '=';
    row.append(out, settings, machine);
  }
}

std::uint32_t parse_seed(std::string_view text) {
  if (text == "random") return fresh_seed();
  return static_cast<std::uint32_t>(number_within(text, "seed", 0, kMaxSeed));
}

// `ignored` leaves the old word beside it as it is: the settings that a reply shows can be loaded again.
void set_life_loss(PlaySettings& settings, LifeLoss life_loss) {
  const bool stays = life_loss == LifeLoss::kIgnored && truncates_on_life_loss(settings);
  settings.life_loss = life_loss;
  settings.machine.truncate_on_life_loss = stays || life_loss == LifeLoss::kRestart;
}

bool truncates_on_life_loss(const PlaySettings& settings) {
  return settings.machine.truncate_on_life_loss && settings.life_loss != LifeLoss::kRestart;
}

Autoreset autoreset_of(std::string_view name) {
  if (name == "0") return Autoreset::kDisabled;  // old words, which logs have, too
  if (name == "1") return Autoreset::kNextStep;
  return value_for(name, "autoreset", kAutoresets);
}

LifeLoss life_loss_of(std::string_view name) { return value_for(name, "life_loss", kLifeLosses); }

std::string_view name_of(Autoreset autoreset) { return word_for(kAutoresets, autoreset); }
std::string_view name_of(ActionSet set) { return word_for(kActionSets, set); }

}  // namespace racebeam
