#include "agents/experiment/plan.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "agents/experiment/game_sets.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/samples.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

std::string refusal_of(const std::string& text) {
  try {
    parse_plan(text, "test.toml");
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

constexpr auto kStart = "games = [\"beamfall\"]\nagents = [\"basic\", \"random\"]\n";

}  // namespace

TEST_CASE("A plan that is written out reads back the same") {
  for (const ShippedPlan& shipped : shipped_plans()) {
    const Plan plan = load_plan(std::string(shipped.name));
    const std::string text = text_of(plan);
    INFO(text);
    CHECK(text_of(parse_plan(text, "again")) == text);
  }
}

TEST_CASE("Presets give the settings of their papers") {
  const Plan paper = parse_plan(kStart, "");
  CHECK(paper.play.machine.frame_skip == 5);
  CHECK(paper.play.machine.sticky == 0);
  CHECK(paper.play.machine.max_episode_frames == 18000);
  CHECK(paper.agents[0].length == TrialLength{30, 5000, 0, 500});
  CHECK(paper.agents[0].values["alpha"] == 0.5);
  CHECK(paper.agents[1].frame_skip == 1);
  CHECK(paper.agents[1].length == TrialLength{1, 0, 0, 500});
  const Plan machado = parse_plan(std::string("preset = \"machado2018\"\n") + kStart, "");
  CHECK(machado.play.machine.sticky == 0.25F);
  CHECK(machado.agents[0].length.training_frames == 200000000);
  CHECK(machado.agents[0].length.training_episodes == 0);
  CHECK(machado.play.noop_max == 0);
  CHECK_FALSE(lives_end(machado));
  const Plan atari = parse_plan(std::string("preset = \"atari100k\"\n") + kStart, "");
  CHECK(atari.play.machine.frame_skip == 4);
  CHECK(atari.play.machine.max_episode_frames == 108000);
  CHECK(atari.agents[0].length.training_frames == 400000);
  const Plan dqn = parse_plan(std::string("preset = \"dqn2015\"\n") + kStart, "");
  CHECK(dqn.play.machine.max_episode_frames == 18000);
  CHECK(dqn.agents[0].length == TrialLength{1, 0, 200000000, 30});
  for (const Plan* const plan : {&atari, &dqn}) {
    CHECK(plan->play.noop_max == 30);
    CHECK(plan->play.action_set == ActionSet::kMinimal);
    CHECK(plan->play.machine.sticky == 0);
    CHECK_FALSE(plan->play.machine.truncate_on_life_loss);
    CHECK(plan->play.machine.reward_max == std::numeric_limits<int>::max());
    CHECK(lives_end(*plan));
    const PlaySettings training = training_settings(*plan, plan->agents[0]);
    CHECK(training.machine.reward_min == -1);
    CHECK(training.machine.reward_max == 1);
    CHECK(training.machine.max_episode_frames == plan->play.machine.max_episode_frames);
    CHECK(training.noop_max == 30);
    CHECK(training.action_set == ActionSet::kMinimal);
    CHECK_FALSE(training.machine.truncate_on_life_loss);
  }
}

TEST_CASE("Mistakes in a plan are named with their line") {
  const auto check = [](const std::string& more, const std::string& expected) {
    CHECK_THAT(refusal_of(kStart + more), Catch::StartsWith(expected));
  };
  check("trails = 1\n", "test.toml:3: trails: unknown key; accepted: name, preset");
  check("name = \"../x\"\n", "test.toml:3: name: '../x' is not a name for a plan; it takes 1 to 64 letters");
  check("trials = 0\n", "test.toml:3: trials: 0 is out of range; accepted: 1 to 1000000");
  check("preset = \"dqn\"\n",
        "test.toml:3: preset: unknown value 'dqn'; accepted: paper2013, machado2018, atari100k, dqn2015");
  check("environment = \"frame_skip=0\"\n", "test.toml:3: environment: frame_skip is '0'");
  check("environment = \"speed=9\"\n", "test.toml:3: environment: unknown setting 'speed'");
  check("environment = \"max_episode_frames=0\"\n", "test.toml:3: environment: max_episode_frames is 0");
  check("environment = \"noop_max=1001\"\n", "test.toml:3: environment: noop_max is '1001'");
  check("environment = \"autoreset=1\"\n",
        "test.toml:3: environment: autoreset is next-step; an episode that is played");
  check("training_environment = \"autoreset=1\"\n",
        "test.toml:3: training_environment: autoreset is next-step");
  check("training_environment = \"life_loss=reported\"\n",
        "test.toml:3: training_environment: an episode is played");
  check("environment = \"life_loss=end\"\n",
        "test.toml:3: environment: an episode is played with life_loss=");
  check("training_environment = \"seed=1\"\n", "test.toml:3: training_environment: seed is not accepted");
  check("training_environment = \"max_episode_frames=0\"\n",
        "test.toml:3: training_environment: max_episode_frames is 0");
  for (const std::string word :
       {"frame_skip=4", "frame_skip=5-6", "action_set=minimal", "mode=1", "difficulty=1"})
    check("training_environment = \"" + word + "\"\n",
          "test.toml:3: training_environment: frame_skip, action_set, mode and difficulty are those of "
          "evaluation");
  check("environment = \"height=220\"\n",
        "test.toml:3: environment: an episode is played with the properties");
  check("environment = \"left=paddles\"\n",
        "test.toml:3: environment: an episode is played with the properties");
  check("environment = \"action_set=small\"\n", "test.toml:3: environment: action_set is 'small'");
  check("environment = \"action_set=console\"\n", "test.toml:3: environment: action_set is console");
  check("environment = \"max_episode_frames=1000001\"\n",
        "test.toml:3: environment: max_episode_frames is 1000001; an experiment accepts 1 to 1000000");
  check("class_screens = 0\n", "test.toml:3: class_screens: 0 is out of range; accepted: 1 to 10000000");
  check("background_screens = 10000001\n", "test.toml:3: background_screens: 10000001 is out of range");
  check("environment = \"seed=7\"\n",
        "test.toml:3: environment: seed is not accepted here; all seeds follow from the plan's key 'seed'");
  check("seed = 4294967295\n", "test.toml:3: seed: 4294967295 is out of range; accepted: 0 to 2147483647");
  check("[backgrounds]\nbeamfall = \"12\"\n",
        "test.toml:4: backgrounds.beamfall: '12' is not a SHA-256; it takes 64");
  for (const std::string& digest : {std::string(63, 'a'), std::string(65, 'a'), std::string(63, 'a') + "A"})
    CHECK_THAT(
        refusal_of(kStart + ("[backgrounds]\nbeamfall = \"" + digest + "\"\n")),
        Catch::StartsWith("test.toml:4: backgrounds.beamfall: 'aaa") && Catch::Contains("is not a SHA-256"));
  check("[backgrounds]\npong = \"12\"\n", "test.toml:4: backgrounds.pong: unknown key; accepted: beamfall");
  check("[agent.basic]\nepsilon = 1.5\n",
        "test.toml:4: agent.basic.epsilon: 1.5 is not accepted; it takes a number from 0 to 1");
  check("[agent.basic]\nalpha = 0\n",
        "test.toml:4: agent.basic.alpha: 0 is not accepted; it takes a number from 1e-09");
  check("[agent.basic]\nalpha = nan\n", "test.toml:4: agent.basic.alpha: ");
  check("[agent.basic]\nalpha = \"much\"\n",
        "test.toml:4: agent.basic.alpha: 'much' is not accepted; it takes a number from 1e-09 to 100");
  check("[agent.basic]\nalpha = true\n",
        "test.toml:4: agent.basic.alpha: true is not accepted; it takes a number from 1e-09 to 100");
  check("[agent.basic]\nframe_skip = 0\n", "test.toml:4: agent.basic.frame_skip: 0 is out of range");
  check("[agent.basic]\nframe_skip = 1001\n", "test.toml:4: agent.basic.frame_skip: 1001 is out of range");
  check("[agent.basic]\nalpha = 100.5\n", "test.toml:4: agent.basic.alpha: 100.5 is not accepted");
  check("[agent.basic]\ngrid_width = 2.5\n",
        "test.toml:4: agent.basic.grid_width: 2.5 is not accepted; it takes a whole number");
  CHECK(refusal_of("games = [\"beamfall\"]\nagents = [\"lsh\"]\n[agent.lsh]\nones = 100001\n") ==
        "test.toml:4: agent.lsh.ones: 100001 is not accepted; it takes a whole number from 1 to 100000");
  check("[agent.basic]\ngrid_width = 17\n",
        "test.toml:4: agent.basic.grid_width: 17 does not divide the screen's 160 pixels");
  check("[agent.basic]\nreward_scale = \"second\"\n",
        "test.toml:4: agent.basic.reward_scale: unknown value 'second'; accepted: first, none and sign");
  check("[agent.basic]\nbeta = 1\n",
        "test.toml:4: agent.basic.beta: unknown key; accepted: frame_skip, trials");
  check("[agent.ram]\nalpha = 1\n", "test.toml:3: agent.ram: this agent is not in agents; add it there");
  check("[agent.rom]\nalpha = 1\n", "test.toml:3: agent.rom: unknown key; accepted: basic and random");
  check("training_episodes = 1\ntraining_frames = 1\n", "test.toml:4: training_frames: training is so many");
  CHECK_THAT(refusal_of("games = [\"beamfal\"]\n"),
             Catch::StartsWith("test.toml:1: games: unknown game 'beamfal'; did you mean beamfall?"));
  CHECK_THAT(refusal_of("games = \"all\"\n"),
             Catch::StartsWith("test.toml:1: games: unknown set 'all'; accepted: training"));
  CHECK_THAT(refusal_of("games = []\n"), Catch::StartsWith("test.toml:1: games: a list in [ ]"));
  CHECK_THAT(refusal_of("games = [\"beamfall\", \"beamfall\"]\n"),
             Catch::StartsWith("test.toml:1: games: 'beamfall' stands twice"));
  CHECK_THAT(refusal_of("games = [\"beamfall\"]\nagents = [\"dqn\"]\n"),
             Catch::StartsWith("test.toml:2: agents: unknown agent 'dqn'; accepted: random, const, perturb"));
  CHECK_THAT(refusal_of("games = ["), Catch::StartsWith("test.toml:1: TOML: "));
}

TEST_CASE("Values of a plan at their limits are accepted") {
  for (const std::string limits :
       {"seed = 0\nclass_screens = 1\nbackground_screens = 1\nenvironment = \"max_episode_frames=1\"\n",
        "seed = 2147483647\nclass_screens = 10000000\nbackground_screens = 10000000\nenvironment = "
        "\"max_episode_frames=1000000\"\n",
        "[agent.basic]\nframe_skip = 1\nepsilon = 0\nalpha = 1e-9\n",
        "[agent.basic]\nframe_skip = 1000\nepsilon = 1\nalpha = 100\n"}) {
    INFO(limits);
    CHECK(refusal_of(kStart + limits) == "");
  }
  const std::string digest = "0123456789abcdef" + std::string(48, 'f');
  const Plan plan = parse_plan(kStart + ("[backgrounds]\nbeamfall = \"" + digest + "\"\n"), "");
  CHECK(plan.games[0].background_csv == digest);
}

TEST_CASE("A plan has at most 100,000 units and 20 million evaluation episodes") {
  const auto refusal = [](int trials, int episodes) {
    return refusal_of("games = [\"beamfall\"]\nagents = [\"basic\"]\ntrials = " + std::to_string(trials) +
                      "\nevaluation_episodes = " + std::to_string(episodes) + "\n");
  };
  CHECK(refusal(100000, 200) == "");
  CHECK(refusal(100001, 1) == "test.toml:3: trials: the plan has 100001 units; accepted: at most 100000");
  CHECK(refusal(100000, 201) ==
        "test.toml:4: evaluation_episodes: the plan has 20100000 evaluation episodes; accepted: at most "
        "20000000");
  const std::string baselines =
      "games = [\"beamfall\", \"updraft\"]\nagents = [\"const\"]\n"
      "evaluation_episodes = 1\n[agent.const]\ntrials = ";
  CHECK(refusal_of(baselines + "2777\n") == "");  // 2 games with 18 actions
  CHECK_THAT(refusal_of(baselines + "2778\n"), Catch::Contains("the plan has 100008 units"));
}

TEST_CASE("Training that is given in episodes or in frames replaces that of the preset") {
  const auto length = [](const std::string& text) { return parse_plan(text + kStart, "").agents[0].length; };
  CHECK(length("training_episodes = 7\n") == TrialLength{30, 7, 0, 500});
  CHECK(length("training_frames = 7\n") == TrialLength{30, 0, 7, 500});
  CHECK(length("training_frames = 1\n") == TrialLength{30, 0, 1, 500});
  CHECK(length("training_frames = 0\n") == TrialLength{30, 5000, 0, 500});
  CHECK(length("training_frames = 7\ntraining_episodes = 0\n") == TrialLength{30, 0, 7, 500});
  const std::string machado = "preset = \"machado2018\"\n";
  CHECK(length(machado + "training_episodes = 7\n") == TrialLength{24, 7, 0, 100});
  CHECK(length(machado + "training_episodes = 1\n") == TrialLength{24, 1, 0, 100});
  CHECK(length(machado + "training_episodes = 0\n") == TrialLength{24, 0, 200000000, 100});
}

TEST_CASE("All games without an image are named at once") {
  Plan plan = parse_plan("games = [\"asterix\", \"beamfall\", \"pong\"]\nagents = [\"random\"]\n", "");
  CHECK_THROWS_WITH(bind(plan, Images(), "0.1.0"),
                    "no image was found for: asterix, pong; --roms names the folder that holds them");
}

TEST_CASE("A mode or a difficulty that a game lacks is refused with its line") {
  for (const std::string word : {"mode", "difficulty"}) {
    Plan plan = parse_plan(kStart + ("environment = \"" + word + "=77\"\n"), "test.toml");
    CHECK_THROWS_WITH(bind(plan, Images(), "0.1.0"),
                      Catch::StartsWith("test.toml:3: environment: beamfall: ") && Catch::Contains(word) &&
                          Catch::Contains("77"));
  }
}

TEST_CASE("A plan of another image or version is refused") {
  const std::string start(kStart);
  Plan plan = parse_plan(start + "version = \"0.0.9\"\n", "");
  CHECK_THROWS_WITH(bind(plan, Images(), "0.1.0"), "the plan is of version '0.0.9'; this program is 0.1.0");
  plan = parse_plan(start + "[images]\nbeamfall = \"abc\"\n", "");
  CHECK_THROWS_WITH(bind(plan, Images(), "0.1.0"),
                    Catch::StartsWith("the plan's image of beamfall has MD5 abc; the available one has "));
}

TEST_CASE("Baselines are 37, in the plan's order, with their own seeds") {
  const Plan plan =
      parse_plan("games = [\"beamfall\", \"updraft\"]\nagents = [\"random\", \"const\", \"perturb\"]\n", "");
  const std::vector<Unit> units = units_of(plan);
  REQUIRE(units.size() == 2 * 37);
  CHECK(units[0].name == "beamfall-random-1");
  CHECK(units[1].name == "beamfall-const_noop-1");
  CHECK(units[36].name == "beamfall-perturb_downleftfire-1");
  CHECK(units[37].name == "updraft-random-1");
  std::set<std::uint32_t> seeds;
  for (const Unit& unit : units) {
    seeds.insert(agent_seed(plan, unit));
    for (const int episode : {1, 2}) {
      for (const bool training : {true, false}) seeds.insert(environment_seed(plan, unit, training, episode));
    }
  }
  CHECK(seeds.size() == units.size() * 5);
}

TEST_CASE("There is a Const for each action of the plan's set") {
  const auto names = [](const std::string& set) {
    const Plan plan = parse_plan(
        "games = [\"updraft\"]\nagents = [\"const\"]\nenvironment = \"action_set=" + set + "\"\n", "");
    std::vector<std::string> list;
    for (const Unit& unit : units_of(plan)) list.push_back(unit.agent_name);
    return list;
  };
  std::vector<std::string> minimal;
  const std::shared_ptr<const Game> updraft = find_game("updraft");
  for (const int action : updraft->minimal_actions)
    minimal.push_back(agent_name(*find_agent_kind("const"), action));
  REQUIRE(minimal.size() < 18);
  CHECK(names("minimal") == minimal);
  CHECK(names("full").size() == 18);
}

TEST_CASE("A plan names a setting that earlier plans lack only if it is not the default") {
  const std::string start = "games = [\"beamfall\"]\nagents = [\"iw1\"]\n[agent.iw1]\n";
  const auto plan = [&](const std::string& line) { return text_of(parse_plan(start + line, "")); };
  CHECK(plan("") == plan("limit_branches = 0\n"));
  CHECK(plan("").find("limit_branches") == std::string::npos);
  CHECK(plan("limit_branches = 1\n").find("limit_branches = 1\n") != std::string::npos);
  CHECK(plan("").find("reward_aside = 1\n") != std::string::npos);
}

TEST_CASE("A plan with other settings of training reads back the same") {
  for (const std::string preset : {"atari100k", "dqn2015"}) {
    const std::string text = text_of(parse_plan("preset = \"" + preset + "\"\n" + kStart, ""));
    INFO(text);
    CHECK(text.find("training_environment = \"") != std::string::npos);
    CHECK(text_of(parse_plan(text, "again")) == text);
  }
  CHECK(text_of(parse_plan(kStart, "")).find("training_environment") == std::string::npos);
  const auto training = [](const std::string& words) {
    return parse_plan("training_environment = \"" + words + "\"\n" + std::string(kStart), "");
  };
  CHECK(lives_end(training("life_loss=end")));
  const Plan restarts = training("life_loss=restart");
  CHECK_FALSE(lives_end(restarts));
  CHECK(training_settings(restarts, restarts.agents[0]).machine.truncate_on_life_loss);
  const Plan plan =
      parse_plan("preset = \"dqn2015\"\ntraining_environment = \"\"\n" + std::string(kStart), "");
  CHECK_FALSE(lives_end(plan));
}

TEST_CASE("The sets of games are the paper's") {
  CHECK(find_game_set("paper")->games.size() == 55);
  CHECK(find_game_set("training")->games.size() == 5);
  CHECK(find_game_set("testing")->games.size() == 50);
  CHECK(find_game_set("atari100k")->games.size() == 26);
  CHECK(find_game_set("atari57")->games.size() == 57);
  for (const GameSet& set : game_sets())
    for (const SetGame& game : set.games) {
      INFO(game.name);
      CHECK(find_game(game.name) != nullptr);
    }
}
