// `open` with steps=frames and a Batch are the same vector environment: what they show is compared, byte for
// byte.
#include <catch2/catch.hpp>
#include <random>

#include "environment/vector/batch.hpp"
#include "protocol/encoding/base64.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using test::code;
using test::LineClient;
using test::value;

namespace {

constexpr std::size_t kMachines = 3;

// One game over both ways. The settings of `load` and of `open`, and the same as a Batch takes them.
struct Case {
  std::string load, open;
  void (*set)(BatchSettings& settings);
};

class Pair {
 public:
  explicit Pair(const Case& one) : batch_(machines(), settings(one)), results_(batch_.make_results()) {
    REQUIRE(client_.ask("load beamfall seed=5 action_set=minimal " + one.load).starts_with("ok"));
    REQUIRE(client_
                .ask("observe reward raw_reward ends game_over lives frame episode_frame ram " + stack() +
                     ":base64")
                .starts_with("ok"));
    batch_.show(results_.arrays());
    compare(client_.ask("open " + std::to_string(kMachines) + " steps=frames " + one.open));
  }

  void step(const std::vector<int>& actions) {
    std::string request = "step";
    for (const int action : actions) request += ' ' + std::to_string(batch_.actions(0)[std::size_t(action)]);
    batch_.step(actions, results_.arrays());
    compare(client_.ask(request));
  }

  void restart(const std::vector<std::uint8_t>& chosen, std::optional<std::int64_t> seed) {
    std::string request = "restart ";
    for (const std::uint8_t one : chosen) request += one != 0 ? '1' : '0';
    std::vector<std::int64_t> seeds;
    for (std::size_t i = 0; seed && i < kMachines; ++i) seeds.push_back(*seed + std::int64_t(i));
    if (seed) request += " seed=" + std::to_string(*seed);
    batch_.reset(results_.arrays(), chosen, seeds);
    compare(client_.ask(request));
  }

  std::ptrdiff_t ended() const { return std::ranges::count(results_.finished, 1); }
  std::size_t actions() const { return batch_.actions(0).size(); }

 private:
  static std::vector<Cartridge> machines() {
    return {kMachines, {load_image("builtin:beamfall"), find_game("beamfall")}};
  }
  BatchSettings settings(const Case& one) {
    BatchSettings settings;
    settings.slot.machine.random_seed = 5;
    settings.slot.machine.sticky = 0;
    one.set(settings);
    stack_ = settings.stack;
    return settings;
  }
  std::string stack() const {
    return (stack_.rgb ? "rgb" : "grey") + std::to_string(stack_.width) + 'x' +
           std::to_string(stack_.height) + 'x' + std::to_string(stack_.depth);
  }

  void compare(const std::string& reply) {
    REQUIRE(code(reply).empty());
    for (std::size_t machine = 0; machine < kMachines; ++machine) {
      const auto check = [&](const std::string& key, std::int64_t expected) {
        INFO(key << " of machine " << machine);
        CHECK(value(reply, key, int(machine) + 1) == std::to_string(expected));
      };
      check("reward", results_.rewards[machine]);
      check("raw_reward", results_.raw_rewards[machine]);
      check("terminated", results_.terminated[machine]);
      check("truncated", results_.truncated[machine]);
      check("game_over", results_.game_over[machine]);
      check("lives", results_.lives[machine]);
      check("frame", results_.frames[machine]);
      check("episode_frame", results_.episode_frames[machine]);
      check_bytes(value(reply, stack(), int(machine) + 1), results_.observations, machine);
      const std::string final_stack = value(reply, "final_" + stack(), int(machine) + 1);
      if (final_stack != "(none)") check_bytes(final_stack, results_.final_observations, machine);
    }
  }

  void check_bytes(const std::string& text, const std::vector<std::uint8_t>& all, std::size_t machine) {
    const std::size_t size = all.size() / kMachines;
    const auto bytes = bytes_of_base64(text);
    REQUIRE(bytes);
    CHECK(std::ranges::equal(*bytes, std::span(all).subspan(machine * size, size)));
  }

  StackSettings stack_;
  Batch batch_;
  BatchResults results_;
  LineClient client_;
};

}  // namespace

TEST_CASE("Machines of open whose steps are frames show what a batch shows") {
  const std::vector<Case> cases = {
      {"sticky=0.25 frame_skip=4 noop_max=30 reward_min=-1 reward_max=1", "",
       [](BatchSettings& s) { s.slot.machine.sticky = 0.25F; }},
      {"sticky=0 frame_skip=7 noop_max=5 max_episode_frames=100",
       "autoreset=same-step lives=end start=noops-fire pool=0",
       [](BatchSettings& s) {
         s.slot.machine.frame_skip = 7;
         s.slot.machine.max_episode_frames = 100;
         s.slot.machine.reward_max = 1 << 30;
         s.slot.machine.reward_min = -(1 << 30);
         s.slot.noop_max = 5;
         s.slot.reset_order = ResetOrder::kNoopsFire;
         s.slot.life_loss = LifeLoss::kEnd;
         s.slot.max_pool = false;
         s.autoreset = Autoreset::kSameStep;
         s.stack = {.depth = 2, .width = 40, .height = 50, .rgb = true};
       }},
      {"sticky=0 frame_skip=30 noop_max=3", "autoreset=disabled lives=restart start=baselines stack=repeats",
       [](BatchSettings& s) {
         s.slot.machine.frame_skip = 30;
         s.slot.machine.reward_max = 1 << 30;
         s.slot.machine.reward_min = -(1 << 30);
         s.slot.noop_max = 3;
         s.slot.reset_order = ResetOrder::kBaselines;
         s.slot.life_loss = LifeLoss::kRestart;
         s.slot.stack_start = StackStart::kRepeats;
         s.autoreset = Autoreset::kDisabled;
       }},
  };
  std::mt19937 random(1);
  std::ptrdiff_t ended = 0;
  for (const Case& one : cases) {
    INFO(one.load << " " << one.open);
    Pair pair(one);
    for (int step = 0; step < 60; ++step) {
      std::vector<int> actions(kMachines);
      for (int& action : actions) action = int(random() % pair.actions());
      pair.step(actions);
      ended += pair.ended();
      if (step % 20 == 19)
        pair.restart({1, 0, 1}, step == 39 ? std::optional<std::int64_t>(70) : std::nullopt);
    }
  }
  CHECK(ended > 20);
}

TEST_CASE("open names the limit of machines") {
  LineClient client;
  client.ask("load beamfall");
  CHECK(client.ask("open 0") == "error bad-value N is '0'; it takes a whole number from 1 to 256");
  CHECK(client.ask("open 257") == "error limit N is 257; the limit is 256 machines");
  CHECK(code(client.ask("open two")) == "bad-value");
}

TEST_CASE("open refuses keys that it does not have, and those of frames with acts") {
  LineClient client;
  client.ask("load beamfall life_loss_ends=1");
  CHECK(client.ask("open 1 pool=0") == "error bad-arguments pool= requires steps=frames");
  CHECK(client.ask("open 1 steps=frames") ==
        "error bad-value a step of frames takes only life_loss for the effect of lost lives");
  CHECK(code(client.ask("open 1 steps=halves")) == "bad-value");
  CHECK(code(client.ask("open 1 step=frames")) == "bad-arguments");
  CHECK(code(client.ask("open 1 steps=acts steps=acts")) == "bad-arguments");
  client.ask("load beamfall");
  CHECK(code(client.ask("open 2 steps=frames")).empty());
  CHECK(code(client.ask("restart 10 seed=-1")) == "bad-value");
  CHECK(code(client.ask("restart seeds=1")) == "bad-arguments");
  CHECK(client.ask("restart 10 01") == "error bad-arguments MASK is given twice");
  CHECK(client.ask("restart seed=1 seed=2") == "error bad-arguments seed is given twice");
  CHECK(code(client.ask("reset seed=x")) == "bad-value");
}

TEST_CASE("A reset with a seed is what load with that seed gives, and keeps the mode") {
  LineClient played, loaded;
  const auto state = [](LineClient& client) {
    client.ask("save a random=1");
    return value(client.ask("export a"), "data");
  };
  played.ask("load updraft seed=1 sticky=0.5 noop_max=20 difficulty=0");
  played.ask("act FIRE*50 UP*3");
  played.ask("reset seed=77");
  loaded.ask("load updraft seed=77 sticky=0.5 noop_max=20 difficulty=0");
  CHECK(state(played) == state(loaded));
  CHECK(played.ask("act FIRE*30 UP*9") == loaded.ask("act FIRE*30 UP*9"));
  CHECK(state(played) == state(loaded));
}

TEST_CASE("The seeds of opened machines count up from that of the last reset with a seed") {
  LineClient played, loaded;
  played.say("load updraft seed=1 sticky=0.5 noop_max=20\nreset seed=77\nopen 3\n");
  loaded.say("load updraft seed=77 sticky=0.5 noop_max=20\nopen 3\n");
  for (const std::string request : {"settings", "step FIRE*9", "step UP*30 FIRE*30"})
    CHECK(played.ask(request) == loaded.ask(request));
}

std::string ask_all(LineClient& client, std::initializer_list<const char*> requests) {
  std::string last;
  for (const char* const request : requests) {
    last = client.ask(request);
    INFO(request);
    CHECK(last.starts_with("ok"));
  }
  return last;
}

TEST_CASE("Machines are opened in the mode and difficulty of the state that was restored last") {
  LineClient client;
  ask_all(client, {"load beamfall seed=7 difficulty=1", "save hard", "set difficulty=0", "restore hard",
                   "open 1", "save opened machine=0", "set difficulty=0", "restore opened"});
  CHECK(value(client.ask("difficulties"), "difficulty") == "1");
}

TEST_CASE("A state that has ended has ended in machines of other kinds, too") {
  LineClient client;
  ask_all(client, {"load beamfall seed=7 sticky=0 frame_skip=4 reward_min=1", "act FIRE*4000", "save over",
                   "observe reward terminated truncated frames", "open 1 steps=frames autoreset=disabled"});
  CHECK(client.ask("restore over machine=0") == "ok reward=0 terminated=1 truncated=0 frames=0");
  CHECK(client.ask("step 0") == "ok machines=1 | over=1 reward=0 terminated=1 truncated=0 frames=0");
  ask_all(client, {"open 1 autoreset=same-step", "restore over machine=0"});
  CHECK(client.ask("step 0") == "ok machines=1 | reward=1 terminated=0 truncated=0 frames=4");
}

TEST_CASE("A reply about a restored machine has the rewards and frames of no earlier step") {
  LineClient client;
  ask_all(client, {"load beamfall seed=7 sticky=0 reward_min=1", "observe reward frames",
                   "open 1 steps=frames", "save begun machine=0"});
  CHECK(client.ask("step FIRE") == "ok machines=1 | reward=1 frames=1");
  CHECK(client.ask("restore begun machine=0") == "ok reward=0 frames=0");
}

TEST_CASE("Frames of acts count against the limit of an episode of steps") {
  LineClient client;
  ask_all(client, {"load beamfall seed=7 sticky=0 frame_skip=4 max_episode_frames=20", "act 0*3",
                   "save three", "branch three keep=leaf 0*2", "act 0*2", "save cut", "observe truncated",
                   "open 1 steps=frames autoreset=disabled"});
  for (const std::string over : {"cut", "leaf0"})
    CHECK(client.ask("restore " + over + " machine=0") == "ok truncated=1");
  CHECK(client.ask("restore three machine=0") == "ok truncated=0");
  CHECK(client.ask("step 0") == "ok machines=1 | truncated=0");
  CHECK(client.ask("step 0") == "ok machines=1 | truncated=1");
}

constexpr const char* kStacked = "load beamfall seed=5 sticky=0.5 noop_max=20 max_episode_frames=90";

TEST_CASE("A state of a machine of open plays on in another as it would have, through resets") {
  LineClient client;
  ask_all(client, {kStacked, "observe reward ends lives episode_frame grey20x20x2:hex",
                   "open 3 steps=frames autoreset=same-step", "step FIRE RIGHT LEFT",
                   "save a machine=1 random=1", "step FIRE*1 UP NOOP"});
  const auto of_two = [&](const std::string& reply) {  // machine 1's group, and machine 2's
    const auto first = reply.find(" | ", reply.find(" | ") + 1), second = reply.find(" | ", first + 1);
    return std::pair(reply.substr(first, second - first), reply.substr(second));
  };
  const std::string one = ask_all(client, {"restore a machine=1"});
  CHECK(ask_all(client, {"restore a machine=2"}) == one);
  for (int step = 0; step < 60; ++step) {
    const auto [machine, other] = of_two(ask_all(client, {step % 3 == 0 ? "step RIGHT" : "step LEFT"}));
    REQUIRE(machine == other);
  }
}

TEST_CASE("A whole export has the score and the stack of screens, and the other has neither") {
  LineClient one, other;
  ask_all(one, {kStacked, "observe grey20x20x2:hex", "open 1 steps=frames", "step FIRE", "step RIGHT",
                "save a machine=0 random=1"});
  const std::string replies = ask_all(one, {"restart 0"});
  const std::string whole = value(one.ask("export a whole=1"), "data"),
                    plain = value(one.ask("export a"), "data");
  CHECK(whole.size() > plain.size());
  CHECK(plain == value(one.ask("export a whole=0"), "data"));
  ask_all(other, {kStacked, "observe grey20x20x2:hex", "open 1 steps=frames"});
  CHECK(other.ask("import a " + whole) == "ok state=a");
  CHECK("ok machines=1 |" + other.ask("restore a machine=0").substr(2) == replies);
  CHECK(other.ask("step RIGHT") == one.ask("step RIGHT"));
  CHECK(value(other.ask("export a whole=1"), "data") == whole);
  CHECK(other.ask("import b " + plain) == "ok state=b");
  CHECK(other.ask("restore b machine=0") ==
        "error bad-state the state has no stack of screens; here, one has a stack of 2 grey screens of 20 x "
        "20");
  CHECK(code(other.ask("restore b")).empty());
  CHECK(code(other.ask("import c " + whole.substr(0, 400))) == "bad-state");
}

TEST_CASE("A state of the machine of load begins the episodes of machines, and the other way round") {
  LineClient client;
  ask_all(client, {"load beamfall seed=5 sticky=0 frame_skip=4", "observe lives ram", "act FIRE*30", "save a",
                   "open 2 steps=frames lives=end"});
  const std::string replies = ask_all(client, {"look"});
  CHECK(ask_all(client, {"restore a machine=1"}) == replies);
  const std::string acted = ask_all(client, {"act RIGHT"});
  const std::string stepped = ask_all(client, {"step RIGHT"});
  CHECK(stepped.ends_with(acted.substr(2)));
  ask_all(client, {"save b machine=1", "act LEFT*9"});
  CHECK(ask_all(client, {"restore b"}) == acted);
}

TEST_CASE("A whole export counts against the longest reply") {
  LineService service = test::line_service();
  service.limits.reply = 3 << 20;
  LineClient client(service);
  ask_all(client, {"load beamfall", "observe rgb160x210x16:raw", "save a"});
  CHECK(code(client.ask("export a whole=1")) == "limit");
  ask_all(client, {"observe none", "save a", "export a whole=1"});
}

TEST_CASE("machine= of save and restore needs a machine of open") {
  LineClient client;
  ask_all(client, {"load beamfall", "save a"});
  CHECK(client.ask("save b machine=0") == "error no-machines machine= needs machines; open some first");
  CHECK(client.ask("restore a machine=0") == "error no-machines machine= needs machines; open some first");
  ask_all(client, {"open 2"});
  CHECK(client.ask("save b machine=2") ==
        "error bad-value machine is '2'; it takes a whole number from 0 to 1");
  CHECK(client.ask("restore a machine=-1") ==
        "error bad-value machine is '-1'; it takes a whole number from 0 to 1");
  CHECK(code(client.ask("restore nothing machine=1")) == "no-state");
  CHECK(client.ask("save b machine=1 machine=1") == "error bad-arguments machine is given twice");
  CHECK(code(client.ask("save b machines=1")) == "bad-arguments");
  CHECK(code(client.ask("restore a random=1")) == "bad-arguments");
  CHECK(code(client.ask("export a whole=2")) == "bad-value");
  CHECK(client.ask("states") == "ok count=1 states=a");
}

TEST_CASE("Stacks of any size are observed, one at a time") {
  LineClient client;
  client.ask("load beamfall");
  const auto size = [&](const std::string& field) {
    const auto bytes = bytes_of_base64(value(client.ask("look " + field + ":base64"), field));
    return bytes ? bytes->size() : 0;
  };
  CHECK(size("grey100x50x1") == 100 * 50);
  CHECK(size("rgb100x50x1") == 100 * 50 * 3);
  CHECK(value(client.ask("look grey160x210x1:hex"), "grey160x210x1") ==
        value(client.ask("look grey:hex"), "grey"));
  CHECK(value(client.ask("look rgb160x210x1:hex"), "rgb160x210x1") ==
        value(client.ask("look rgb:hex"), "rgb"));
  CHECK(value(client.ask("look grey84x84x1:hex"), "grey84x84x1") ==
        value(client.ask("look grey84:hex"), "grey84"));
  for (const std::string field :
       {"grey84x", "grey84x4x", "grey10", "rgb84", "rgb84x4", "grey1x2x3x4", "greyWxHxN"})
    CHECK_FALSE(code(client.ask("observe " + field)).empty());
  CHECK(client.ask("observe grey84x4 rgb20x20x1") ==
        "error bad-arguments grey84x4 and rgb20x20x1 are two stacks of screens; a session can select one");
  CHECK(client.ask("observe grey321x84x1") ==
        "error bad-value the width of a stack is '321'; it takes a whole number from 1 to 320");
  CHECK(client.ask("observe grey84x421x1") ==
        "error bad-value the height of an observation is 421; it takes 9 to 420, or 0 for the screen's own");
  CHECK(client.ask("observe") == "ok fields=reward,terminated,truncated,lives");
}
