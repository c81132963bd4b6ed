#include "agents/experiment/play.hpp"

#include <algorithm>

#include "agents/base/episode_start.hpp"
#include "environment/input/has_paddles.hpp"
#include "games/game/actions.hpp"
#include "recording/episode_account.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

// Plays actions and keeps account of them.
class Player {
 public:
  Player(Environment& machine, LifeLoss life_loss) : machine_(machine), life_loss_(life_loss) {}

  double act(int action, float strength = 1) {
    const int before = machine_.frame_number();
    const int reward = machine_.act({.a = action, .strength_a = strength});
    account_.add(machine_, frames_between(before, machine_.frame_number()));
    return reward;
  }

  std::int64_t decisions() const { return account_.decisions(); }
  std::int64_t frames() const { return account_.frames(); }
  bool over() const { return machine_.game_over(); }
  EpisodeEnd finish() { return account_.finish(machine_, life_loss_); }
  std::vector<std::uint64_t> take_hashes() { return account_.take_hashes(); }

 private:
  Environment& machine_;
  const LifeLoss life_loss_;
  EpisodeAccount account_;
};

}  // namespace

void check_episode_settings(const PlaySettings& settings) {
  if (settings.autoreset != Autoreset::kDisabled)
    throw InvalidInput("autoreset is " + std::string(name_of(settings.autoreset)) +
                       "; an episode that is played ends, so that autoreset=disabled is accepted");
  if (settings.life_loss != LifeLoss::kIgnored && settings.life_loss != LifeLoss::kRestart)
    throw InvalidInput("an episode is played with life_loss=ignored or life_loss=restart");
  if (!settings.console.empty())
    throw InvalidInput(
        "an episode is played with the properties of its image; scheme, left, right, format, ystart and "
        "height "
        "are not accepted");
}

Stage::Stage(const Cartridge& cartridge, const PlaySettings& settings, Drawing drawing)
    : settings_(settings), machine_(cartridge.image, cartridge.game, settings.machine) {
  check_episode_settings(settings);
  machine_.set_drawing(drawing);
}

void Stage::begin(std::uint32_t seed) {
  settings_.machine.random_seed = seed;
  begin_episode(machine_, settings_, seed);
}

Episode play(Agent& agent, Stage& stage, const PlayOptions& options) {
  Environment& machine = stage.machine();
  Player player(machine, stage.settings().life_loss);
  Episode episode;
  for (int action = agent.begin(machine);;) {
    episode.actions.push_back(static_cast<std::uint8_t>(action));
    const int lives = machine.lives();
    const double reward = player.act(action);
    if (options.on_decision) options.on_decision(player.decisions(), player.frames());
    const bool over = player.over() || player.frames() >= options.most_frames;
    const bool ends = over || (options.lives_end && machine.lives() < lives);
    if (ends) agent.end(reward);
    if (over) break;
    action = ends ? agent.begin(machine) : agent.next(reward, machine);
    if (agent.diverged()) break;
  }
  episode.diverged = agent.diverged();
  episode.end = player.finish();
  episode.hashes = player.take_hashes();
  return episode;
}

PlaySettings settings_of(const EpisodeLog& log) {
  PlaySettings settings;
  std::vector<std::string_view> words;
  split(log.settings, words);
  read_settings(words, settings);
  return settings;
}

void Replayer::keep(std::unique_ptr<Stage> stage) {
  const std::scoped_lock lock(mutex_);
  kept_.push_back(std::move(stage));
  if (kept_.size() > most_kept_) kept_.pop_front();
}

Replay Replayer::play(const EpisodeLog& log, const Cartridge& cartridge) {
  PlaySettings settings = settings_of(log);
  settings.machine.cpu = cpu_;
  auto stage = std::make_unique<Stage>(cartridge, settings, Drawing::kNone);
  stage->begin(settings.machine.random_seed);
  const std::vector<int> actions =
      actions_of(settings.action_set, *cartridge.game, properties_of(stage->machine()));
  Player player(stage->machine(), settings.life_loss);
  for (std::size_t i = 0; i < log.actions.size(); ++i) {
    const int action = log.actions[i];
    if (player.over()) break;
    if (std::ranges::find(actions, action) == actions.end())
      throw InvalidInput("its log has the action " + std::string(action_name(action)) +
                         ", which is not in the set " + std::string(name_of(settings.action_set)));
    player.act(action, log.strength(i));
  }
  Replay result;
  result.end = player.finish();
  result.hashes = player.take_hashes();
  result.over = player.over();
  keep(std::move(stage));
  return result;
}

}  // namespace racebeam
