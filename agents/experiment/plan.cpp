#include "agents/experiment/plan.hpp"

#include <algorithm>
#include <span>

#include "agents/experiment/plan_keys.hpp"
#include "agents/experiment/play.hpp"
#include "emulator/state/state_hash.hpp"
#include "recording/phrase_seed.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

void append_line(std::string& out, std::string_view key, const std::string& value) {
  ((out += key) += " = ").append(value) += '\n';
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string list = "[";
  for (const std::string& name : names) (list += list.size() > 1 ? ", \"" : "\"").append(name) += '"';
  return list + "]";
}

std::string value_text(const AgentSetting& setting, double value) {
  std::string text;
  if (setting.choices.empty()) {
    append_number(text, value);
    return text;
  }
  return std::string("\"").append(setting.choices[static_cast<std::size_t>(value)]) + '"';
}

void append_agent(std::string& out, const PlanAgent& agent) {
  out.append("\n[agent.").append(agent.kind->name) += "]\n";
  append_line(out, "frame_skip", std::to_string(agent.frame_skip));
  for (const LengthKey& key : kLengthKeys)
    append_line(out, key.name, std::to_string(agent.length.*key.member));
  for (const AgentSetting& setting : agent.values.settings()) {
    const double value = agent.values[setting.name];
    if (!setting.is_later || value != setting.value)
      append_line(out, setting.name, value_text(setting, value));
  }
}

// The settings of the environment without a seed, as words of `load`. They do not depend on the game.
std::string environment_words(const PlaySettings& settings) {
  const Environment any(load_image("builtin:beamfall"), find_game("beamfall"), Settings{});
  const std::string text = words_of(settings, any);
  std::vector<std::string_view> all;
  split(text, all);
  std::string words;
  for (const std::string_view word : all)
    if (!word.starts_with("seed=")) (words += words.empty() ? "" : " ") += word;
  return words;
}

std::uint32_t seed_from(const Plan& plan, const Unit& unit, std::string_view purpose, std::uint32_t number) {
  StateHash hash;
  const std::string text = unit.name + '/' + std::string(purpose);
  hash.add(plan.seed);
  hash.add(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  hash.add(number);
  return static_cast<std::uint32_t>(hash.value() >> 32);
}

}  // namespace

std::vector<std::string> games_without_image(const Plan& plan, const Images& images) {
  std::vector<std::string> missing;
  for (const PlanGame& game : plan.games)
    if (!images.find(game.name)) missing.push_back(game.name);
  return missing;
}

namespace {

// Whether the game has the mode and the difficulty of the plan.
void check_game(const Plan& plan, const Cartridge& cartridge) {
  try {
    Stage(cartridge, plan.play, Drawing::kNone).begin(1);
  } catch (const InvalidInput& error) {
    throw InvalidInput(plan.environment_place + cartridge.game->name + ": " + error.what());
  }
}

}  // namespace

void bind(Plan& plan, const Images& images, const std::string& version) {
  if (!plan.version.empty() && plan.version != version)
    throw InvalidInput("the plan is of version " + quote(plan.version) + "; this program is " + version);
  plan.version = version;
  std::string missing;
  for (const std::string& name : games_without_image(plan, images))
    (missing += missing.empty() ? "" : ", ") += name;
  if (!missing.empty())
    throw InvalidInput("no image was found for: " + missing + "; --roms names the folder that holds them");
  for (PlanGame& game : plan.games) {
    const std::string& found = images.find(game.name)->image->md5;
    if (!game.image_md5.empty() && game.image_md5 != found)
      throw InvalidInput("the plan's image of " + game.name + " has MD5 " + game.image_md5 +
                         "; the available one has " + found);
    game.image_md5 = found;
    check_game(plan, *images.find(game.name));
  }
}

std::string text_of(const Plan& plan) {
  std::vector<std::string> games, agents;
  for (const PlanGame& game : plan.games) games.push_back(game.name);
  for (const PlanAgent& agent : plan.agents) agents.emplace_back(agent.kind->name);
  std::string out;
  append_line(out, "name", '"' + plan.name + '"');
  append_line(out, "version", '"' + plan.version + '"');
  append_line(out, "seed", std::to_string(plan.seed));
  if (!plan.phrase.empty()) append_line(out, "phrase", '"' + plan.phrase + '"');
  for (const ScreensKey& key : kScreensKeys) append_line(out, key.name, std::to_string(plan.*key.member));
  const std::string evaluation = environment_words(plan.play), training = environment_words(plan.training);
  append_line(out, "environment", '"' + evaluation + '"');
  if (training != evaluation) append_line(out, "training_environment", '"' + training + '"');
  append_line(out, "games", quoted_list(games));
  append_line(out, "agents", quoted_list(agents));
  out += "\n[images]\n";
  for (const PlanGame& game : plan.games) append_line(out, game.name, '"' + game.image_md5 + '"');
  if (std::ranges::any_of(plan.games, [](const PlanGame& game) { return !game.background_csv.empty(); }))
    out += "\n[backgrounds]\n";
  for (const PlanGame& game : plan.games)
    if (!game.background_csv.empty()) append_line(out, game.name, '"' + game.background_csv + '"');
  for (const PlanAgent& agent : plan.agents) append_agent(out, agent);
  return out;
}

std::vector<int> actions_of_agents(const PlanGame& game, const AgentKind& kind) {
  return kind.each_action ? game.actions : std::vector<int>{0};
}

std::vector<Unit> units_of(const Plan& plan) {
  std::vector<Unit> units;
  for (const PlanGame& game : plan.games) {
    for (const PlanAgent& agent : plan.agents) {
      for (const int action : actions_of_agents(game, *agent.kind)) {
        const std::string name = agent_name(*agent.kind, action);
        for (int trial = 1; trial <= agent.length.trials; ++trial)
          units.push_back(
              {game.name + '-' + name + '-' + std::to_string(trial), &game, &agent, name, action, trial});
      }
    }
  }
  return units;
}

SampleSettings sample_settings(const Plan& plan, const PlanGame& game) {
  return {plan.seed, plan.background_screens, plan.class_screens,
          plan.play, game.background_csv,     plan.version};
}

PlaySettings play_settings(const Plan& plan, const PlanAgent& agent) {
  PlaySettings play = plan.play;
  play.machine.frame_skip = agent.frame_skip;
  return play;
}

PlaySettings training_settings(const Plan& plan, const PlanAgent& agent) {
  PlaySettings play = plan.training;
  play.machine.frame_skip = agent.frame_skip;
  if (lives_end(plan)) set_life_loss(play, LifeLoss::kIgnored);
  return play;
}

bool lives_end(const Plan& plan) { return plan.training.life_loss == LifeLoss::kEnd; }

std::uint32_t agent_seed(const Plan& plan, const Unit& unit) { return seed_from(plan, unit, "agent", 0); }

std::uint32_t environment_seed(const Plan& plan, const Unit& unit, bool training, int episode) {
  if (!training && !plan.phrase.empty())
    return seed_of_phrase(plan.phrase, unit.game->name, unit.trial, episode);
  const auto number = static_cast<std::uint32_t>(episode);
  return std::max(seed_from(plan, unit, training ? "training" : "evaluation", number), 1U);
}

}  // namespace racebeam
