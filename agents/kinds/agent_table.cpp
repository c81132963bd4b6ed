#include "agents/kinds/agent_table.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "agents/features/blob_features.hpp"
#include "agents/features/game_facts.hpp"
#include "agents/features/locality_hash.hpp"
#include "agents/features/object_features.hpp"
#include "agents/features/ram_bits.hpp"
#include "agents/features/tile_colours.hpp"
#include "agents/kinds/baselines.hpp"
#include "agents/kinds/learner.hpp"
#include "agents/kinds/planner.hpp"
#include "agents/kinds/ram_learner.hpp"
#include "agents/planning/rollout_search.hpp"
#include "agents/planning/search_tree.hpp"
#include "agents/planning/uct.hpp"
#include "system/named_rows.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr std::array kPerturbSettings = {
    AgentSetting{"probability", 0.95, 0, 1, false, "section 3.1.3: of the fixed action"},
};

constexpr std::array<WordFor<RewardScale>, 3> kRewardScales = {
    {{"first", RewardScale::kFirst}, {"none", RewardScale::kNone}, {"sign", RewardScale::kSign}}};
constexpr auto kNamesOfRewardScales = name_array(kRewardScales);

constexpr double kMinStep = 1e-9, kMaxStep = 100;
constexpr int kMaxVectors = 65535, kMaxOnes = 100000;
constexpr int kMaxBuckets = 20000;  // a sum of 100,000 hashes fits into 31 bits

constexpr AgentSetting alpha(double value, std::string_view source) {
  return {"alpha", value, kMinStep, kMaxStep, false, source};
}
constexpr AgentSetting lambda(double value, std::string_view source) {
  return {"lambda", value, 0, 1, false, source};
}
constexpr AgentSetting kGamma{"gamma", 0.999, 0, 1, false, "appendix C, All agents"};
constexpr AgentSetting kEpsilon{"epsilon", 0.05, 0, 1, false, "appendix C, All agents"};
constexpr AgentSetting kEvaluationEpsilon{
    "evaluation_epsilon", 0.05, 0, 1, false, "docs/paper-notes.md, Evaluation"};
constexpr AgentSetting kLeastTrace{"least_trace", 0.01, 0, 1, false, "docs/paper-notes.md, Traces"};
constexpr AgentSetting kClearTraces{"clear_other_traces", 0, 0, 1, true, "docs/paper-notes.md, Traces"};
constexpr AgentSetting kRewardScale{"reward_scale",      0, 0, 2, true, "docs/paper-notes.md, Rewards",
                                    kNamesOfRewardScales};

constexpr std::array kTileSettings = {
    alpha(0.5, "appendix C, BASS and Basic"),
    lambda(0.9, "appendix C, BASS and Basic"),
    kGamma,
    kEpsilon,
    kEvaluationEpsilon,
    kLeastTrace,
    kClearTraces,
    kRewardScale,
    AgentSetting{"grid_width", 16, 1, 160, true, "appendix C, BASS and Basic", {}, kFeatureWidth},
    AgentSetting{"grid_height", 14, 1, 210, true, "appendix C, BASS and Basic", {}, kFeatureHeight}};
constexpr std::array kDiscoSettings = {alpha(0.1, "appendix C, DISCO"),
                                       lambda(0.9, "appendix C, DISCO"),
                                       kGamma,
                                       kEpsilon,
                                       kEvaluationEpsilon,
                                       kLeastTrace,
                                       kClearTraces,
                                       kRewardScale,
                                       AgentSetting{"tilings", 8, 1, 64, true, "appendix C, DISCO"},
                                       AgentSetting{"grid", 8, 1, 64, true, "appendix C, DISCO"},
                                       AgentSetting{"count_instances", 1, 0, 1, true, "appendix A.3"}};
constexpr std::array kLshSettings = {alpha(0.5, "appendix C, LSH"),
                                     lambda(0.5, "appendix C, LSH"),
                                     kGamma,
                                     kEpsilon,
                                     kEvaluationEpsilon,
                                     kLeastTrace,
                                     kClearTraces,
                                     kRewardScale,
                                     AgentSetting{"vectors", 2000, 1, kMaxVectors, true, "appendix C, LSH"},
                                     AgentSetting{"ones", 1000, 1, kMaxOnes, true, "appendix C, LSH"},
                                     AgentSetting{"buckets", 50, 1, kMaxBuckets, true, "appendix C, LSH"}};
constexpr std::array kRamSettings = {alpha(0.2, "appendix C, RAM-based"),
                                     lambda(0.5, "appendix C, RAM-based"),
                                     kGamma,
                                     kEpsilon,
                                     kEvaluationEpsilon,
                                     kLeastTrace,
                                     kClearTraces,
                                     kRewardScale};
constexpr std::string_view kLiang = "Liang et al. 2016";
constexpr std::array kBlobSettings = {
    alpha(0.5, kLiang),
    lambda(0.9, kLiang),
    AgentSetting{"gamma", 0.99, 0, 1, false, kLiang},
    AgentSetting{"epsilon", 0.01, 0, 1, false, kLiang},
    AgentSetting{"evaluation_epsilon", 0.01, 0, 1, false, "docs/paper-notes.md, Evaluation"},
    kLeastTrace,
    kClearTraces,
    kRewardScale,
    AgentSetting{"blob_distance", 6, 1, 210, true, kLiang},
    AgentSetting{"most_features", 10e6, 1, 114702400, true, "docs/paper-notes.md, Successors"}};

constexpr AgentSetting frames_of(double value, std::string_view source) {
  return {"frames", value, 1, 1e9, true, source};
}
constexpr AgentSetting merge(double value, std::string_view source) {
  return {"merge_duplicates", value, 0, 1, true, source};
}
constexpr AgentSetting reuse(double value, std::string_view source) {
  return {"reuse_tree", value, 0, 1, true, source};
}
constexpr std::string_view kLipovetzky = "Lipovetzky et al. 2015", kBandres = "Bandres et al. 2018";
constexpr AgentSetting kWidthGamma{"gamma", 0.995, 0, 1, false, kLipovetzky};
constexpr std::array kFullTreeSettings = {frames_of(133000, "appendix C, Full-tree search"), kGamma,
                                          merge(0, "docs/paper-notes.md, Full tree"),
                                          reuse(0, "docs/paper-notes.md, Full tree"), kRewardScale};
constexpr std::array kWidthSettings = {
    frames_of(150000, kLipovetzky),
    kWidthGamma,
    merge(0, "docs/paper-notes.md, Full tree"),
    reuse(1, "docs/paper-notes.md, IW(1)"),
    AgentSetting{"reward_aside", 1, 0, 2, true, "docs/paper-notes.md, IW(1)"},
    AgentSetting{.name = "limit_branches",
                 .value = 0,
                 .least = 0,
                 .most = 1,
                 .whole = true,
                 .source = "docs/paper-notes.md, IW(1)",
                 .is_later = true},
    kRewardScale};
constexpr std::array kRolloutSettings = {frames_of(150000, "docs/paper-notes.md, Rollout-IW(1)"), kWidthGamma,
                                         reuse(1, kBandres), kRewardScale};
constexpr std::array kUctSettings = {AgentSetting{"simulations", 500, 1, 1e9, true, "appendix C, UCT"},
                                     AgentSetting{"depth_frames", 300, 1, 1e6, true, "appendix C, UCT"},
                                     AgentSetting{"exploration", 0.1, 0, 1e6, false, "appendix C, UCT"},
                                     kGamma,
                                     merge(1, "section 3.2.1"),
                                     kRewardScale};

RewardScale reward_scale(const AgentValues& values) {
  return kRewardScales[static_cast<std::size_t>(values.whole("reward_scale"))].value;
}

SarsaSettings sarsa_settings(const AgentValues& values) {
  return {.step_size = values["alpha"],
          .trace_decay = values["lambda"],
          .discount = values["gamma"],
          .exploration = values["epsilon"],
          .evaluation_exploration = values["evaluation_epsilon"],
          .least_trace = values["least_trace"],
          .clear_other_traces = values["clear_other_traces"] != 0,
          .reward_scale = reward_scale(values)};
}

std::unique_ptr<Agent> learner(const AgentContext& context, std::unique_ptr<FeatureSet> features) {
  return std::make_unique<Learner>(std::move(features), sarsa_settings(context.values), context.seed,
                                   context.actions());
}

std::unique_ptr<Agent> tile_learner(const AgentContext& context, int colours, bool pairs) {
  const AgentValues& values = context.values;
  return learner(context,
                 std::make_unique<TileColours>(context.facts->background(), values.whole("grid_width"),
                                               values.whole("grid_height"), colours, pairs));
}

std::unique_ptr<Agent> make_basic(const AgentContext& context) {
  return tile_learner(context, kColours, false);
}
std::unique_ptr<Agent> make_bass(const AgentContext& context) { return tile_learner(context, 8, true); }

std::unique_ptr<Agent> make_disco(const AgentContext& context) {
  const AgentValues& values = context.values;
  const ObjectSettings settings{.tilings = values.whole("tilings"),
                                .grid = values.whole("grid"),
                                .reach = reach_of(context.play.machine.frame_skip),
                                .count_instances = values["count_instances"] != 0};
  return learner(context, std::make_unique<ObjectFeatures>(context.facts->background(),
                                                           context.facts->classes(), settings));
}

std::unique_ptr<Agent> make_lsh(const AgentContext& context) {
  const AgentValues& values = context.values;
  return learner(context, std::make_unique<LocalityHash>(values.whole("vectors"), values.whole("ones"),
                                                         values.whole("buckets"), context.seed + 1));
}

std::unique_ptr<Agent> make_ram(const AgentContext& context) {
  const SarsaSettings settings = sarsa_settings(context.values);
  if (PairWeights::decisions_of_trace(settings) == 0) return learner(context, std::make_unique<RamBits>());
  return std::make_unique<RamLearner>(settings, context.seed, context.actions());
}

std::unique_ptr<Agent> make_blob_prost(const AgentContext& context) {
  const AgentValues& values = context.values;
  return std::make_unique<Learner>(std::make_unique<BlobFeatures>(values.whole("blob_distance")),
                                   FeatureGroups(static_cast<std::size_t>(values["most_features"])),
                                   sarsa_settings(values), context.seed, context.actions());
}

std::unique_ptr<Agent> make_random(const AgentContext& context) {
  return std::make_unique<FixedPolicy>(0, 0.0, context.seed, context.actions());
}

std::unique_ptr<Agent> make_const(const AgentContext& context) {
  return std::make_unique<FixedPolicy>(context.action, 1.0, context.seed, context.actions());
}

std::unique_ptr<Agent> make_perturb(const AgentContext& context) {
  return std::make_unique<FixedPolicy>(context.action, context.values["probability"], context.seed,
                                       context.actions());
}

template <typename Search, typename Settings>
std::unique_ptr<Agent> planner(const AgentContext& context, const Settings& settings) {
  return std::make_unique<Planner<Search, Settings>>(context, settings);
}

TreeSettings tree_settings(const AgentValues& values) {
  return {.frames = values.whole("frames"),
          .discount = values["gamma"],
          .merge_duplicates = values["merge_duplicates"] != 0,
          .reuse_tree = values["reuse_tree"] != 0,
          .reward_scale = reward_scale(values)};
}

std::unique_ptr<Agent> make_full_tree(const AgentContext& context) {
  return planner<TreeSearch>(context, tree_settings(context.values));
}

std::unique_ptr<Agent> make_iw1(const AgentContext& context) {
  TreeSettings settings = tree_settings(context.values);
  settings.needs_novelty = true;
  settings.reward_aside = static_cast<RewardAside>(context.values.whole("reward_aside"));
  // A branch is full when it has as many nodes as one search can make.
  if (context.values["limit_branches"] != 0)
    settings.full_branch = static_cast<std::size_t>(
        std::max<std::int64_t>(settings.frames / context.play.machine.frame_skip, 1));
  return planner<TreeSearch>(context, settings);
}

std::unique_ptr<Agent> make_rollout_iw1(const AgentContext& context) {
  const AgentValues& values = context.values;
  return planner<RolloutSearch>(context, RolloutSettings{.frames = values.whole("frames"),
                                                         .discount = values["gamma"],
                                                         .reuse_tree = values["reuse_tree"] != 0,
                                                         .reward_scale = reward_scale(values)});
}

std::unique_ptr<Agent> make_uct(const AgentContext& context) {
  const AgentValues& values = context.values;
  const int depth = values.whole("depth_frames") / context.play.machine.frame_skip;
  return planner<Uct>(context, UctSettings{.simulations = values.whole("simulations"),
                                           .depth = std::max(depth, 1),
                                           .exploration = values["exploration"],
                                           .discount = values["gamma"],
                                           .merge_duplicates = values["merge_duplicates"] != 0,
                                           .reward_scale = reward_scale(values)});
}

double tiles(const AgentValues& values) { return values.growth("grid_width") * values.growth("grid_height"); }
Effort effort_of_basic(const AgentValues& values) { return {tiles(values), tiles(values)}; }
Effort effort_of_bass(const AgentValues& values) {
  const double pairs = tiles(values) * tiles(values);
  return {pairs, pairs};
}
Effort effort_of_disco(const AgentValues& values) {
  const double tilings = values.growth("tilings"), tiles = values.growth("grid") * values.growth("grid");
  return {tilings, tilings * tiles * tiles};
}
// Half of the memory are the weights, and half the vectors.
Effort effort_of_lsh(const AgentValues& values) {
  const double vectors = values.growth("vectors");
  return {vectors, vectors * (values.growth("buckets") + values.growth("ones")) / 2};
}
Effort effort_of_tree(const AgentValues& values) {
  return {values.growth("frames"), values.growth("frames")};
}
Effort effort_of_uct(const AgentValues& values) {
  const double simulations = values.growth("simulations");
  return {simulations * values.growth("depth_frames"), simulations};
}

constexpr std::array kKinds = {
    AgentKind{.name = "random",
              .summary = "a random action on every frame",
              .role = Role::kBaseline,
              .frame_skip = 1,
              .settings = {},
              .decisions_per_second = 120000,
              .megabytes = 2,
              .make = make_random},
    AgentKind{.name = "const",
              .summary = "one action throughout; 18 agents",
              .role = Role::kBaseline,
              .each_action = true,
              .frame_skip = {},
              .settings = {},
              .decisions_per_second = 25000,
              .megabytes = 2,
              .make = make_const},
    AgentKind{.name = "perturb",
              .summary = "one action, sometimes a random one, drawn on every frame; 18 agents",
              .role = Role::kBaseline,
              .each_action = true,
              .frame_skip = 1,
              .settings = kPerturbSettings,
              .decisions_per_second = 120000,
              .megabytes = 2,
              .make = make_perturb},
    AgentKind{.name = "basic",
              .summary = "SARSA on the colours of 16 x 14 tiles",
              .role = Role::kLearner,
              .frame_skip = {},
              .settings = kTileSettings,
              .decisions_per_second = 9100,
              .megabytes = 20,
              .effort = effort_of_basic,
              .make = make_basic},
    AgentKind{.name = "bass",
              .summary = "SARSA on SECAM's colours of tiles, and all pairs of these",
              .role = Role::kLearner,
              .frame_skip = {},
              .settings = kTileSettings,
              .decisions_per_second = 5000,
              .megabytes = 340,
              .effort = effort_of_bass,
              .make = make_bass},
    AgentKind{.name = "disco",
              .summary = "SARSA on places and velocities of objects of discovered classes",
              .role = Role::kLearner,
              .frame_skip = {},
              .settings = kDiscoSettings,
              .decisions_per_second = 4000,
              .megabytes = 540,
              .effort = effort_of_disco,
              .make = make_disco},
    AgentKind{.name = "lsh",
              .summary = "SARSA on locality sensitive hashes of the screen",
              .role = Role::kLearner,
              .frame_skip = {},
              .settings = kLshSettings,
              .decisions_per_second = 3600,
              .megabytes = 40,
              .effort = effort_of_lsh,
              .make = make_lsh},
    AgentKind{.name = "ram",
              .summary = "SARSA on the bits of RAM, and all pairs of these",
              .role = Role::kLearner,
              .frame_skip = {},
              .settings = kRamSettings,
              .decisions_per_second = 1200,  // cautious: five games had 1,200 to 9,000
              .megabytes = 120,
              .make = make_ram},
    AgentKind{.name = "blob_prost",
              .summary = "Blob-PROST: SARSA on blobs, and their offsets in space and time",
              .role = Role::kLearner,
              .frame_skip = {},
              .settings = kBlobSettings,
              .decisions_per_second = 2600,
              .megabytes = 110,  // 40 after 20,000 decisions; it grows with the features that were seen
              .make = make_blob_prost},
    AgentKind{.name = "full_tree",
              .summary = "breadth-first search of the tree of all actions",
              .role = Role::kPlanner,
              .frame_skip = {},
              .settings = kFullTreeSettings,
              .decisions_per_second = 0.7,
              .megabytes = 130,
              .effort = effort_of_tree,
              .make = make_full_tree},
    AgentKind{.name = "uct",
              .summary = "UCT with random rollouts",
              .role = Role::kPlanner,
              .frame_skip = {},
              .settings = kUctSettings,
              .decisions_per_second = 1,  // cautious: three games had 3.2 to 31 (docs/results.md)
              .megabytes = 10,
              .effort = effort_of_uct,
              .make = make_uct},
    AgentKind{.name = "iw1",
              .summary = "IW(1): breadth-first search of states with a new byte of RAM",
              .role = Role::kPlanner,
              .frame_skip = {},
              .settings = kWidthSettings,
              .decisions_per_second = 1,  // cautious: two games had 2.0 and 3.4 (docs/results.md)
              .megabytes = 900,           // 830 in Beam Rider, where kept subtrees are large
              .effort = effort_of_tree,
              .make = make_iw1},
    AgentKind{.name = "rollout_iw1",
              .summary = "Rollout-IW(1): random ways to states with a new byte of RAM",
              .role = Role::kPlanner,
              .frame_skip = {},
              .settings = kRolloutSettings,
              .decisions_per_second = 1,
              .megabytes = 130,
              .effort = effort_of_tree,
              .make = make_rollout_iw1},
};

}  // namespace

AgentValues::AgentValues(std::span<const AgentSetting> settings) : settings_(settings) {
  for (const AgentSetting& setting : settings) values_.push_back(setting.value);
}

double AgentValues::operator[](std::string_view name) const { return values_[place_of(name)]; }

double AgentValues::growth(std::string_view name) const {
  const std::size_t place = place_of(name);
  return values_[place] / settings_[place].value;
}

std::size_t AgentValues::place_of(std::string_view name) const {
  const auto found = std::ranges::find(settings_, name, &AgentSetting::name);
  if (found == settings_.end()) throw std::out_of_range("no setting " + std::string(name));
  return static_cast<std::size_t>(found - settings_.begin());
}

std::span<const AgentKind> agent_kinds() { return kKinds; }

const AgentKind* find_agent_kind(std::string_view name) {
  const auto found = std::ranges::find(kKinds, name, &AgentKind::name);
  return found == kKinds.end() ? nullptr : &*found;
}

std::string agent_name(const AgentKind& kind, int action) {
  std::string name(kind.name);
  if (kind.each_action) (name += '_') += lower_case(action_name(action));
  return name;
}

}  // namespace racebeam
