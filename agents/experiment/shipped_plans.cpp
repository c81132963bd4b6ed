// The plans that are part of the program.
#include <array>

#include "agents/experiment/plan.hpp"

namespace racebeam {
namespace {

constexpr std::array kPlans = {
    ShippedPlan{"paper", "all of the paper: 55 games, learners, searches, 37 baselines", R"(name = "paper"
preset = "paper2013"
games = "paper"
agents = ["random", "const", "perturb", "basic", "bass", "disco", "lsh", "ram", "full_tree", "uct"]

[agent.random]
evaluation_episodes = 30
[agent.const]
evaluation_episodes = 30
[agent.perturb]
evaluation_episodes = 30
)"},
    ShippedPlan{"hour", "the five training games, for an hour on two cores", R"(name = "hour"
preset = "paper2013"
games = "training"
agents = ["random", "basic", "bass", "disco", "lsh", "ram"]
trials = 2
training_frames = 1000000
evaluation_episodes = 30
)"},
    ShippedPlan{"smoke", "our own games, for half a minute", R"(name = "smoke"
preset = "paper2013"
games = ["beamfall", "updraft"]
agents = ["random", "const", "perturb", "basic", "disco", "lsh", "ram", "uct", "iw1"]
trials = 1
training_episodes = 10
evaluation_episodes = 2
background_screens = 2000
class_screens = 2000

[agent.uct]
trials = 2
simulations = 10
[agent.iw1]
trials = 1
frames = 500
)"},
};

}  // namespace

std::span<const ShippedPlan> shipped_plans() { return kPlans; }

}  // namespace racebeam
