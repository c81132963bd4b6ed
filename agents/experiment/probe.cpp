#include "agents/experiment/probe.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "agents/experiment/play.hpp"
#include "agents/experiment/settling_rate.hpp"
#include "agents/features/game_facts.hpp"
#include "system/clock.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::size_t kMaxProbes = 60, kMaxActions = 4;
constexpr Seconds kLongestProbe{2};
constexpr double kMaxWaiting = 10;  // on a busy machine, a probe ends after this multiple of its share
constexpr double kMaxLearning = 8;  // a learner's speed may take this multiple of its share to settle
// The probe discovers facts from fewer screens than an experiment: one in kMaxShare, or more if that were
// fewer than kMinScreens.
constexpr int kMaxShare = 12, kMinScreens = 600;

struct Enough {};  // ends an episode

// Processor time of this thread, which other programs do not change.
Seconds time_of_thread() { return std::chrono::nanoseconds(processor_time()); }

// How long episodes were.
struct Lengths {
  double frames = 0;
  int ends = 0;  // the others were cut

  // All frames for each end: a mean of whole episodes would prefer short ones, since the time cuts long ones.
  double mean() const { return frames / ends; }
};

// What an agent did in a game.
struct Sums {
  double seconds_per_decision = 0;  // of all agents
  int agents = 0;
  double discovery_seconds = 0;
  Lengths lengths;
};

// An agent, for as long as it is measured.
class Probe {
 public:
  Probe(const Plan& plan, const PlanGame& game, const PlanAgent& agent, const Cartridge& cartridge)
      : agent_(agent),
        share_(share_of(plan)),
        cartridge_(cartridge),
        play_(play_settings(plan, agent)),
        trains_(agent.length.training_episodes > 0 || agent.length.training_frames > 0),
        facts_(cartridge, samples_of(plan, game), ""),
        stage_(cartridge, trains_ ? training_settings(plan, agent) : play_, Drawing::kNone) {}

  // Each of some of a kind's agents plays for a part of the time.
  Sums play(const std::vector<int>& actions, Seconds time) {
    const std::size_t count = std::min(actions.size(), kMaxActions);
    for (std::size_t i = 0; i < count; ++i) play(actions[i * actions.size() / count], time / count);
    return sums_;
  }

 private:
  static int share_of(const Plan& plan) {
    return std::clamp(plan.background_screens / kMinScreens, 1, kMaxShare);
  }

  static SampleSettings samples_of(const Plan& plan, const PlanGame& game) {
    SampleSettings samples = sample_settings(plan, game);
    samples.background_csv.clear();
    samples.background_screens = std::max(samples.background_screens / share_of(plan), 1);
    samples.class_screens = std::max(samples.class_screens / share_of(plan), 1);
    return samples;
  }

  // The first of a kind's agents discovers what they all know.
  std::unique_ptr<Agent> make(int action) {
    const auto start = time_of_thread();
    auto agent = agent_.kind->make({agent_.values, action, 1, cartridge_, play_, &facts_});
    const Seconds took = time_of_thread() - start;
    if (!agent_.kind->each_action) {
      const auto again = time_of_thread();
      agent = agent_.kind->make({agent_.values, action, 1, cartridge_, play_, &facts_});
      sums_.discovery_seconds = std::max((took - (time_of_thread() - again)).count(), 0.0) * share_;
    }
    return agent;
  }

  void play(int action, Seconds time) {
    const std::unique_ptr<Agent> agent = make(action);
    stage_.machine().set_drawing(agent->drawing());
    agent->set_learning(trains_);
    const Seconds most = trains_ ? time * kMaxLearning : time, start = time_of_thread();
    const auto end = Clock::now() + most * kMaxWaiting;
    SettlingRate rate(time.count(), most.count());
    std::int64_t frames = 0;
    const PlayOptions options{.on_decision = [&](std::int64_t, std::int64_t frames_now) {
      frames = frames_now;
      const bool waits = trains_ && sums_.lengths.ends == 0;  // for the end of an episode
      if (rate.add((time_of_thread() - start).count(), waits) || Clock::now() >= end) throw Enough();
    }};
    try {
      for (std::uint32_t seed = 1; !agent->diverged(); ++seed) {
        stage_.begin(seed);
        racebeam::play(*agent, stage_, options);
        sums_.lengths.frames += static_cast<double>(std::exchange(frames, 0));
        ++sums_.lengths.ends;
      }
    } catch (const Enough&) {
      sums_.lengths.frames += static_cast<double>(frames);
    }
    if (rate.rate() == 0) return;
    sums_.seconds_per_decision += 1 / rate.rate();
    ++sums_.agents;
  }

  const PlanAgent& agent_;
  const int share_;
  const Cartridge cartridge_;
  const PlaySettings play_;
  const bool trains_;
  GameFacts facts_;
  Stage stage_;
  Sums sums_;
};

// A search plays better than what can be measured in a moment, so that its episodes are taken to be as long
// as they may be.
PlayRate rate_of(const Plan& plan, const PlanAgent& agent, const Sums& sums, const Lengths& lengths) {
  const double longest = plan.play.machine.max_episode_frames;
  const bool is_known = lengths.ends > 0 && agent.kind->role != Role::kPlanner;
  return {.episode_frames = is_known ? std::min(lengths.mean(), longest) : longest,
          .decisions_per_second = sums.agents / sums.seconds_per_decision,
          .discovery_seconds = sums.discovery_seconds};
}

// Returns nothing if the agent cannot be measured.
std::optional<Sums> measure(const Plan& plan, const PlanGame& game, const PlanAgent& agent,
                            const Cartridge& cartridge, Seconds time) {
  try {
    Sums sums = Probe(plan, game, agent, cartridge).play(actions_of_agents(game, *agent.kind), time);
    if (sums.agents > 0) return sums;
  } catch (const std::bad_alloc&) {  // too little memory to measure: the table's speed counts
  } catch (const InvalidInput&) {    // a setting that the game lacks, which a run refuses
  }
  return {};
}

// Returns `most` of the games that have an image, evenly spaced.
std::vector<const PlanGame*> some_games(const Plan& plan, const Images& images, std::size_t most) {
  std::vector<const PlanGame*> all, some;
  for (const PlanGame& game : plan.games)
    if (images.find(game.name)) all.push_back(&game);
  const std::size_t count = std::min(all.size(), std::max<std::size_t>(most, 1));
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

}  // namespace

// A moment has few episodes of each learner, so that all learners of a game get the mean of their episodes.
PlayRates measure_rates(const Plan& plan, const Images& images, std::chrono::duration<double> time) {
  const std::vector<const PlanGame*> games = some_games(plan, images, kMaxProbes / plan.agents.size());
  const auto count = static_cast<double>(games.size() * plan.agents.size());
  PlayRates rates;
  for (const PlanGame* const game : games) {
    std::vector<std::pair<const PlanAgent*, Sums>> measured;
    Lengths of_learners;
    for (const PlanAgent& agent : plan.agents) {
      const std::optional<Sums> sums =
          measure(plan, *game, agent, *images.find(game->name), std::min(time / count, kLongestProbe));
      if (!sums) continue;
      measured.emplace_back(&agent, *sums);
      if (agent.kind->role != Role::kLearner) continue;
      of_learners.frames += sums->lengths.frames;
      of_learners.ends += sums->lengths.ends;
    }
    for (const auto& [agent, sums] : measured)
      rates.add(
          *game, *agent,
          rate_of(plan, *agent, sums, agent->kind->role == Role::kLearner ? of_learners : sums.lengths));
  }
  return rates;
}

}  // namespace racebeam
