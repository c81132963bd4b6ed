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
agents = ["random", "const", "perturb", "basic", "disco", "lsh", "ram", "blob_prost", "uct", "iw1"]
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
    ShippedPlan{"baselines", "Random and the 36 Const and Perturb policies in all 55 games",
                R"(name = "baselines"
games = "paper"
agents = ["random", "const", "perturb"]
evaluation_episodes = 30
)"},
    ShippedPlan{"basic", "Basic for 2,000,000 decisions in two games", R"(name = "basic"
games = ["asterix", "freeway"]
agents = ["random", "basic"]
trials = 1
training_frames = 10000000
evaluation_episodes = 30
)"},
    ShippedPlan{"perturb", "the 18 Perturb policies in all 55 games", R"(name = "perturb"
games = "paper"
agents = ["perturb"]
evaluation_episodes = 30
)"},
    ShippedPlan{"learners", "four learners as long as in the paper, three trials in each of five games",
                R"(name = "learners"
games = "training"
agents = ["basic", "bass", "disco", "lsh"]
trials = 3
)"},
    ShippedPlan{"ram", "RAM as long as in the paper, a trial in each of five games", R"(name = "ram"
games = "training"
agents = ["ram"]
trials = 1
)"},
    ShippedPlan{"blob_prost", "Blob-PROST for 2,000 episodes, a trial in each of five games",
                R"(name = "blob_prost"
games = "training"
agents = ["blob_prost"]
trials = 1
training_episodes = 2000
)"},
    ShippedPlan{"uct", "UCT with 500 simulations, an episode in each of three games", R"(name = "uct"
games = ["boxing", "asterix", "seaquest"]
agents = ["uct"]
[agent.uct]
trials = 1
)"},
    ShippedPlan{"uct10", "UCT with 10 simulations, two episodes in each of two games", R"(name = "uct10"
games = ["asterix", "seaquest"]
agents = ["uct"]
[agent.uct]
trials = 2
simulations = 10
)"},
    ShippedPlan{"uct50", "UCT with 50 simulations, two episodes in each of two games", R"(name = "uct50"
games = ["asterix", "seaquest"]
agents = ["uct"]
[agent.uct]
trials = 2
simulations = 50
)"},
    ShippedPlan{"uct150", "UCT with 150 simulations, two episodes in each of two games", R"(name = "uct150"
games = ["asterix", "seaquest"]
agents = ["uct"]
[agent.uct]
trials = 2
simulations = 150
)"},
    ShippedPlan{"full_tree", "full-tree search, an episode of Asterix", R"(name = "full_tree"
games = ["asterix"]
agents = ["full_tree"]
[agent.full_tree]
trials = 1
)"},
    ShippedPlan{"iw1", "IW(1), an episode in each of two games", R"(name = "iw1"
games = ["asterix", "freeway"]
agents = ["iw1"]
[agent.iw1]
trials = 1
)"},
    ShippedPlan{"searches", "four searches at full budget, an episode in each of ten games",
                R"(name = "searches"
games = ["asterix", "beam_rider", "freeway", "seaquest", "space_invaders",
         "pong", "breakout", "ms_pacman", "qbert", "boxing"]
agents = ["uct", "full_tree", "iw1", "rollout_iw1"]
[agent.uct]
trials = 1
[agent.full_tree]
trials = 1
[agent.iw1]
trials = 1
[agent.rollout_iw1]
trials = 1
)"},
};

}  // namespace

std::span<const ShippedPlan> shipped_plans() { return kPlans; }

}  // namespace racebeam
