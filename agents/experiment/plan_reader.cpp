#include "agents/experiment/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "agents/experiment/game_sets.hpp"
#include "agents/experiment/plan_keys.hpp"
#include "agents/experiment/play.hpp"
#include "environment/settings/setting_tables.hpp"
#include "games/files/toml_section.hpp"
#include "recording/phrase_seed.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/similar.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr int kMaxEpisodeFrames = 1000000;  // a log holds this many decisions
constexpr int kMaxScreens = 10000000;
constexpr int kMaxFrameSkip = 1000;
constexpr std::int64_t kMaxUnits = 100000, kMaxRows = 20000000;  // of results.csv: 4 GiB

// Settings of the literature, which a plan then changes.
struct PlanPreset {
  std::string_view name;
  std::string_view training;  // words of `load`: what training has otherwise
  TrialLength learners;
};
constexpr std::array kPresets = {
    PlanPreset{"paper2013", "", {.trials = 30, .training_episodes = 5000, .evaluation_episodes = 500}},
    PlanPreset{"machado2018", "", {.trials = 24, .training_frames = 200000000, .evaluation_episodes = 100}},
    PlanPreset{"atari100k",
               "preset=dqn2015 life_loss=end max_episode_frames=108000",
               {.trials = 5, .training_frames = 400000, .evaluation_episodes = 100}},
    PlanPreset{"dqn2015",
               "preset=dqn2015 life_loss=end",
               {.trials = 1, .training_frames = 200000000, .evaluation_episodes = 30}},
};

static_assert(std::ranges::equal(kPresets, description::kEvaluationPresets, {}, &PlanPreset::name,
                                 &description::EvaluationPreset::name));

// A number as errors show it. Whole numbers have all their digits: 100000, not 1e+05.
std::string number_text(double value) {
  constexpr double kMaxDecimal = 1e15;
  if (value == std::floor(value) && std::abs(value) < kMaxDecimal)
    return std::to_string(static_cast<std::int64_t>(value));
  std::string text;
  append_number(text, value);
  return text;
}

template <typename Rows>
std::string list_of(const Rows& rows) {
  std::string list;
  for (const auto& row : rows) (list += list.empty() ? "" : ", ") += row.name;
  return list;
}

class PlanReader {
 public:
  PlanReader(std::string_view text, const std::string& file, const Images& images)
      : source_{text, file}, table_(parse_toml(source_)), top_(source_, table_, ""), images_(images) {}

  Plan read() {
    top_.allow(kTopKeys);
    plan_.name = top_.text("name").value_or("experiment");
    if (top_.node("name")) top_.guard(*top_.node("name"), "name", [&] { checked_name(plan_.name, "plan"); });
    if (top_.node("seed")) plan_.seed = static_cast<std::uint32_t>(*top_.number("seed", 0, kMaxNumberOfPlan));
    plan_.phrase = top_.text("phrase").value_or("");
    if (top_.node("phrase")) top_.guard(*top_.node("phrase"), "phrase", [&] { check_phrase(plan_.phrase); });
    for (const ScreensKey& key : kScreensKeys)
      if (top_.node(key.name)) plan_.*key.member = *top_.number(key.name, 1, kMaxScreens);
    plan_.version = top_.text("version").value_or("");
    read_preset();
    read_lengths(top_, learners_);
    read_environment();
    read_games();
    read_images();
    read_backgrounds();
    read_agents();
    check_size();
    return std::move(plan_);
  }

 private:
  static constexpr std::array<std::string_view, 18> kTopKeys = {"name",
                                                                "preset",
                                                                "seed",
                                                                "phrase",
                                                                "background_screens",
                                                                "class_screens",
                                                                "trials",
                                                                "training_episodes",
                                                                "training_frames",
                                                                "evaluation_episodes",
                                                                "environment",
                                                                "training_environment",
                                                                "games",
                                                                "images",
                                                                "backgrounds",
                                                                "agents",
                                                                "agent",
                                                                "version"};

  void read_preset() {
    const std::string name = top_.text("preset").value_or("paper2013");
    const auto found = std::ranges::find(kPresets, name, &PlanPreset::name);
    if (found == kPresets.end())
      top_.refuse(*top_.node("preset"), "preset",
                  "unknown value " + quote(name) + "; accepted: " + list_of(kPresets));
    read_words(std::string(description::kEvaluationPresets[found - kPresets.begin()].words), plan_.play);
    training_words_ = found->training;
    learners_ = found->learners;
  }

  static void read_words(const std::string& text, PlaySettings& settings) {
    std::vector<std::string_view> words;
    split(text, words);
    read_settings(words, settings);
  }

  void read_environment() {
    if (const toml::node* const node = top_.node("environment")) {
      plan_.environment_place =
          source_.file + ":" + std::to_string(node->source().begin.line) + ": environment: ";
      read_settings_of("environment", *top_.text("environment"), plan_.play);
    }
    plan_.training = plan_.play;
    const bool is_preset = !top_.node("training_environment");
    if (is_preset) return read_words(training_words_, plan_.training);
    read_settings_of("training_environment", *top_.text("training_environment"), plan_.training);
    check_same_agent(*top_.node("training_environment"));
  }

  // The settings of a preset are accepted.
  void read_settings_of(std::string_view key, const std::string& text, PlaySettings& settings) const {
    const toml::node& node = *top_.node(key);
    top_.guard(node, key, [&] {
      read_words(text, settings);
      PlaySettings played = settings;
      if (&settings == &plan_.training && played.life_loss == LifeLoss::kEnd)
        set_life_loss(played, LifeLoss::kIgnored);
      check_episode_settings(played);
      if (settings.action_set == ActionSet::kConsole)
        throw InvalidInput("action_set is console; agents choose from full, legal or minimal");
    });
    if (has_seed(text))
      top_.refuse(node, key, "seed is not accepted here; all seeds follow from the plan's key 'seed'");
    const int limit = settings.machine.max_episode_frames;
    if (limit < 1 || limit > kMaxEpisodeFrames)
      top_.refuse(node, key,
                  "max_episode_frames is " + std::to_string(limit) + "; an experiment accepts 1 to " +
                      std::to_string(kMaxEpisodeFrames));
  }

  // What an agent is made of cannot change between training and evaluation.
  void check_same_agent(const toml::node& node) const {
    const PlaySettings &evaluation = plan_.play, &training = plan_.training;
    if (training.machine.frame_skip == evaluation.machine.frame_skip &&
        training.machine.frame_skip_max == evaluation.machine.frame_skip_max &&
        training.action_set == evaluation.action_set && training.mode == evaluation.mode &&
        training.difficulty == evaluation.difficulty)
      return;
    top_.refuse(node, "training_environment",
                "frame_skip, action_set, mode and difficulty are those of evaluation; the key "
                "'environment' sets them");
  }

  static bool has_seed(const std::string& text) {
    std::vector<std::string_view> words;
    split(text, words);
    return std::ranges::any_of(words, [](std::string_view word) { return word.starts_with("seed="); });
  }

  // What `section` says of the length of a trial. Training has one length, in episodes or in frames.
  void read_lengths(const Section& section, TrialLength& length) const {
    for (const LengthKey& key : kLengthKeys) {
      if (!section.node(key.name)) continue;
      length.*key.member = *section.number(key.name, key.least, key.most);
    }
    const bool episodes = section.node("training_episodes"), frames = section.node("training_frames");
    if (frames && !episodes && length.training_frames > 0) length.training_episodes = 0;
    if (episodes && !frames && length.training_episodes > 0) length.training_frames = 0;
    if (length.training_episodes > 0 && length.training_frames > 0)
      section.refuse(*section.node("training_frames"), "training_frames",
                     "training is so many episodes or so many frames, not both; one of them must be 0");
  }

  std::vector<std::string> words(std::string_view key) const {
    const toml::array* const list = top_.list(key);
    if (!list || list->empty()) top_.refuse_missing(key, "a list in [ ] with at least one name is required");
    std::vector<std::string> names;
    for (const toml::node& item : *list) {
      const auto name = item.value_exact<std::string>();
      if (!name) top_.refuse(item, key, "must be a text in quotes");
      if (std::ranges::find(names, *name) != names.end())
        top_.refuse(item, key, quote(*name) + " stands twice");
      check_(item, key, *name);
      names.push_back(*name);
    }
    return names;
  }

  void read_games() {
    if (top_.node("games") && top_.node("games")->is_string()) {
      const std::string name = *top_.text("games");
      const GameSet* const set = find_game_set(name);
      if (!set)
        top_.refuse(
            *top_.node("games"), "games",
            "unknown set " + quote(name) + "; accepted: " + list_of(game_sets()) + ", and a list of games");
      for (const SetGame& game : set->games) add_game(std::string(game.name));
      return;
    }
    check_ = [this](const toml::node& at, std::string_view key, const std::string& name) {
      if (!images_.rules(name))
        top_.refuse(at, key,
                    "unknown game " + quote(name) + ";" + did_you_mean(name, game_names()) +
                        " racebeam games lists them");
    };
    for (const std::string& name : words("games")) add_game(name);
  }

  void add_game(const std::string& name) {
    plan_.games.push_back({.name = name, .actions = actions_of(plan_.play.action_set, *images_.rules(name))});
  }

  // A table whose keys are games of the plan, if there is one.
  std::optional<Section> section_of_games(std::string_view key) const {
    const toml::table* const table = top_.table(key);
    if (!table) return std::nullopt;
    Section section(source_, *table, std::string(key));
    std::vector<std::string_view> names;
    for (const PlanGame& game : plan_.games) names.push_back(game.name);
    section.allow(names);
    return section;
  }

  void read_images() {
    const auto section = section_of_games("images");
    if (!section) return;
    for (PlanGame& game : plan_.games) game.image_md5 = section->text(game.name).value_or("");
  }

  // The SHA-256 of the CSV files that games have their backgrounds from.
  void read_backgrounds() {
    const auto section = section_of_games("backgrounds");
    if (!section) return;
    for (PlanGame& game : plan_.games) {
      const auto digest = section->text(game.name);
      if (!digest) continue;
      if (digest->size() != 64 || digest->find_first_not_of("0123456789abcdef") != std::string::npos)
        section->refuse(*section->node(game.name), game.name,
                        quote(*digest) + " is not a SHA-256; it takes 64 digits of 0 to 9 and a to f");
      game.background_csv = *digest;
    }
  }

  void read_agents() {
    check_ = [this](const toml::node& at, std::string_view key, const std::string& name) {
      if (!find_agent_kind(name))
        top_.refuse(at, key, "unknown agent " + quote(name) + "; accepted: " + list_of(agent_kinds()));
    };
    const std::vector<std::string> names = words("agents");
    const toml::table* const tables = top_.table("agent");
    const toml::table none;
    const Section all(source_, tables ? *tables : none, "agent");
    for (const AgentKind& kind : agent_kinds())
      if (all.node(kind.name) && std::ranges::find(names, kind.name) == names.end())
        all.refuse(*all.node(kind.name), kind.name, "this agent is not in agents; add it there");
    all.allow(std::vector<std::string_view>(names.begin(), names.end()));
    for (const std::string& name : names) {
      const toml::table* const own = all.table(name);
      plan_.agents.push_back(
          agent(*find_agent_kind(name), Section(source_, own ? *own : none, "agent." + name)));
    }
  }

  // Units and rows are kept in memory, by experiments and by their verification.
  void check_size() const {
    std::int64_t units = 0, rows = 0;
    for (const PlanAgent& agent : plan_.agents) {
      std::int64_t agents = 0;
      for (const PlanGame& game : plan_.games)
        agents += static_cast<std::int64_t>(actions_of_agents(game, *agent.kind).size());
      const std::int64_t own = agents * agent.length.trials;
      units += own;
      rows += own * agent.length.evaluation_episodes;
    }
    const auto check = [&](std::string_view key, std::int64_t count, const char* what, std::int64_t most) {
      if (count <= most) return;
      const std::string sentence =
          "the plan has " + std::to_string(count) + what + "; accepted: at most " + std::to_string(most);
      if (top_.node(key)) top_.refuse(*top_.node(key), key, sentence);
      top_.refuse_missing(key, sentence);
    };
    check("trials", units, " units", kMaxUnits);
    check("evaluation_episodes", rows, " evaluation episodes", kMaxRows);
  }

  // Baselines learn nothing, and a search has an episode a trial, so that episodes run side by side.
  TrialLength length_for(const AgentKind& kind) const {
    if (kind.role == Role::kLearner) return learners_;
    if (kind.role == Role::kPlanner) return {.trials = 10};
    return {.evaluation_episodes = learners_.evaluation_episodes};
  }

  PlanAgent agent(const AgentKind& kind, const Section& section) const {
    std::vector<std::string_view> keys{"frame_skip"};
    for (const LengthKey& key : kLengthKeys) keys.push_back(key.name);
    for (const AgentSetting& setting : kind.settings) keys.push_back(setting.name);
    section.allow(keys);
    PlanAgent agent{&kind, AgentValues(kind.settings), length_for(kind),
                    kind.frame_skip.value_or(plan_.play.machine.frame_skip)};
    read_lengths(section, agent.length);
    if (section.node("frame_skip")) agent.frame_skip = *section.number("frame_skip", 1, kMaxFrameSkip);
    for (std::size_t i = 0; i < kind.settings.size(); ++i)
      if (section.node(kind.settings[i].name)) agent.values.set(i, value(section, kind.settings[i]));
    return agent;
  }

  // A value as it stands in the plan.
  static std::string source_text(const toml::node& node) {
    if (const auto text = node.value_exact<std::string>()) return quote(*text);
    const auto flag = node.value_exact<bool>();
    return flag ? (*flag ? "true" : "false") : "this value";
  }

  static double value(const Section& section, const AgentSetting& setting) {
    const toml::node& node = *section.node(setting.name);
    if (!setting.choices.empty())
      return *section.choice(setting.name, {setting.choices.begin(), setting.choices.end()});
    const double number = node.is_number() ? node.value<double>().value() : NAN;
    const bool accepted =
        number >= setting.least && number <= setting.most && (!setting.whole || number == std::floor(number));
    if (!accepted)
      section.refuse(node, setting.name,
                     (node.is_number() ? number_text(number) : source_text(node)) +
                         " is not accepted; it takes a " + (setting.whole ? "whole number" : "number") +
                         " from " + number_text(setting.least) + " to " + number_text(setting.most));
    if (setting.divides != 0 && setting.divides % static_cast<int>(number) != 0)
      section.refuse(node, setting.name,
                     number_text(number) + " does not divide the screen's " +
                         std::to_string(setting.divides) + " pixels");
    return number;
  }

  TomlSource source_;
  toml::table table_;
  Section top_;
  const Images& images_;
  std::function<void(const toml::node& at, std::string_view key, const std::string& name)> check_;
  TrialLength learners_;
  std::string training_words_;  // of the preset
  Plan plan_;
};

}  // namespace

Plan parse_plan(std::string_view text, const std::string& file, const Images& images) {
  return PlanReader(text, file, images).read();
}

Plan load_plan(const std::string& name_or_file, const Images& images) {
  const auto shipped = std::ranges::find(shipped_plans(), name_or_file, &ShippedPlan::name);
  if (shipped != shipped_plans().end()) return parse_plan(shipped->text, "plan " + name_or_file, images);
  if (name_or_file.find_first_of("./") == std::string::npos)
    throw InvalidInput("unknown plan " + quote(name_or_file) + "; accepted: " + list_of(shipped_plans()) +
                       ", or a file, whose name contains . or /");
  return parse_plan(read_input_file("plan", name_or_file, kMaxPlanBytes), name_or_file, images);
}

}  // namespace racebeam
