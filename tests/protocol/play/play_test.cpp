// States, branches and many machines over the line protocol.
#include <zlib.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <thread>

#include "protocol/encoding/base64.hpp"
#include "system/words.hpp"
#include "tests/protocol/duel.hpp"

using namespace racebeam;
using namespace std::chrono_literals;
using Catch::Matchers::Contains;
using test::code;
using test::line_service;
using test::LineClient;
using test::value;

namespace {

const std::string kEverything =
    "observe reward ends lives frame episode_frame ram screen:rle grey84x4 rgb audio";

struct Playing : LineClient {
  explicit Playing(const std::string& words = "", const LineService& with = line_service())
      : LineClient(with) {
    REQUIRE(code(ask("load beamfall seed=7 sound=1 " + words)) == "");
    REQUIRE(code(ask(kEverything)) == "");
  }
};

constexpr std::size_t kHeader = 24, kChecksum = 20;  // of a state's bytes, see saved_state_format.cpp

std::vector<std::uint8_t> exported(LineClient& client, const std::string& name) {
  return bytes_of_base64(value(client.ask("export " + name), "data")).value();
}

// A state as text, with its checksum.
std::string forged(std::vector<std::uint8_t> bytes) {
  const auto checksum =
      static_cast<std::uint32_t>(crc32(0, bytes.data() + kHeader, static_cast<uInt>(bytes.size() - kHeader)));
  std::memcpy(bytes.data() + kChecksum, &checksum, sizeof checksum);
  std::string text;
  append_base64(text, bytes);
  return text;
}

}  // namespace

TEST_CASE("Returning to a state gives back all that replies show, then and later") {
  Playing client("sticky=0.25 frame_skip=2-4");
  client.ask("act FIRE*30");
  const std::string at_save = client.ask("look");
  client.ask("save here random=1");
  const std::string after = client.ask("act UP*5 FIRE*20");
  client.say("reset\nact RIGHT*40\n");
  CHECK(value(client.ask("restore here"), "screen") == value(at_save, "screen"));
  CHECK(value(client.ask("look"), "grey84x4") == value(at_save, "grey84x4"));
  CHECK(value(client.ask("look"), "audio") == value(at_save, "audio"));
  CHECK(client.ask("act UP*5 FIRE*20") == after);
}

TEST_CASE("A state can be taken to another process") {
  Playing one("sticky=0"), other("sticky=0");
  one.say("act FIRE*30\nsave here\n");
  const std::string text = value(one.ask("export here"), "data");
  CHECK(other.ask("import there " + text) == "ok state=there");
  other.ask("restore there");
  CHECK(other.ask("look ram screen:hex frame") == one.ask("look ram screen:hex frame"));
  one.ask("observe reward lives ram screen:rle");
  other.ask("observe reward lives ram screen:rle");
  CHECK(other.ask("act UP*9 FIRE*30") == one.ask("act UP*9 FIRE*30"));
}

TEST_CASE("A state of a variation for two can be taken in") {
  LineClient client;
  client.say("load beamfall as=pong\nset mode=2\nsave here\n");  // pong lists 0 and 1; the others are for two
  CHECK(value(client.ask("import there " + value(client.ask("export here"), "data")), "state") == "there");
}

TEST_CASE("A state that came with its generator passes it on to the ends of branches") {
  Playing client("sticky=0.5 frame_skip=2-4");
  client.say("act FIRE*30\nsave here random=1\n");
  client.ask("import there " + value(client.ask("export here"), "data"));
  client.ask("branch there keep=leaf FIRE*20");
  client.ask("restore leaf0");
  const std::string after = client.ask("act FIRE*50");
  client.say("act UP*7\nrestore leaf0\n");
  CHECK(client.ask("act FIRE*50") == after);
}

TEST_CASE("look shows the small screen that replies show") {
  for (const std::string frames : {"1", "4"}) {
    LineClient client;
    client.ask("load beamfall seed=7 sticky=0 frame_skip=" + frames);
    client.say("observe grey84:hex\nact FIRE*9\nsave here\n");
    for (const std::string request :
         {"act FIRE*9", "act UP", "restore here", "act DOWN", "reset", "act FIRE*2"}) {
      const std::string reply = client.ask(request);
      CHECK(client.ask("look grey84:hex") == reply);
    }
  }
}

TEST_CASE("A state that was cut, altered or belongs to another game is refused") {
  Playing client("sticky=0");
  client.ask("save here");
  std::string text = value(client.ask("export here"), "data");
  CHECK(code(client.ask("import x " + text.substr(0, text.size() / 8 * 4))) == "bad-state");
  CHECK(code(client.ask("import x " + text.substr(1))) == "bad-state");
  CHECK(code(client.ask("import x AAAA")) == "bad-state");
  LineClient updraft;
  updraft.ask("load updraft");
  CHECK(code(updraft.ask("import x " + text)) == "bad-state");
  text[400] = text[400] == 'A' ? 'B' : 'A';
  CHECK(code(client.ask("import x " + text)) == "bad-state");
  CHECK(code(client.ask("restore x")) == "no-state");
}

TEST_CASE("A state that names another image with bytes that are not text is refused in one line") {
  Playing client("sticky=0");
  client.ask("save here");
  auto bytes = exported(client, "here");
  bytes[kHeader] = '\n';
  bytes[kHeader + 1] = 0xFF;
  const std::string reply = client.ask("import x " + forged(bytes));
  CHECK_THAT(reply, Contains("error bad-state the state is of the image with MD5 \\x0a\\xff"));
  CHECK(std::ranges::all_of(reply, [](char c) { return c >= ' ' && c <= '~'; }));
}

TEST_CASE("Frames are counted beyond the largest number of them") {
  Playing client("sticky=0");
  client.say("observe frame frames acts\nact NOOP*77\nsave here\n");
  const auto before = exported(client, "here");
  client.say("act NOOP\nsave here\n");
  auto bytes = exported(client, "here");
  constexpr std::size_t kValues = kHeader + 108;  // after the image, the game and three sizes
  const std::uint32_t frame = 78, last = 2147483647;
  std::size_t at =
      kValues;  // the counter: what went from 77 to 78, there twice, of the game and of the episode
  while (std::memcmp(&bytes[at], &frame, 4) != 0 || before[at] != 77 || before[at + 4] != 77) ++at;
  std::memcpy(&bytes[at], &last, sizeof last);
  client.say("import x " + forged(bytes) + "\nrestore x\n");
  CHECK(client.ask("act NOOP*3") == "ok frame=-2147483646 frames=3 acts=3");
  CHECK_THAT(client.ask("branch x NOOP*3"), Contains(" acts=3 "));
}

TEST_CASE("A branch answers what playing would have, and leaves the session where it is") {
  for (const std::string settings : {"sticky=0", "sticky=0.25"}) {
    Playing client(settings);
    client.say("act FIRE*30\nsave root random=1\nact UP*7\n");
    const std::string before = client.ask("look");
    const std::string branches = client.ask("branch root FIRE*100 UP*5,FIRE*20,NOOP NOOP*5000");
    CHECK(client.ask("look") == before);
    const std::string later = client.ask("act FIRE*50");
    const std::vector<std::string> played = {"act FIRE*100", "act UP*5 FIRE*20 NOOP", "act NOOP*5000"};
    for (int branch = 0; branch < 3; ++branch) {
      client.ask("restore root");
      const std::string direct = client.ask(played[static_cast<std::size_t>(branch)]);
      for (const std::string key : {"reward", "terminated", "truncated", "lives"})
        CHECK(value(branches, key, branch + 1) == value(direct, key));
    }
    Playing undisturbed(settings);
    undisturbed.say("act FIRE*30\nact UP*7\n");
    CHECK(undisturbed.ask("act FIRE*50") == later);
  }
}

TEST_CASE("The rewards of a branch are those of its acts") {
  Playing client("sticky=0 frame_skip=4");
  client.say("save root\nobserve reward\n");
  const std::string rewards = value(client.ask("branch root FIRE*60"), "rewards", 1);
  std::string expected;
  for (int act = 0; act < 60; ++act) (expected += value(client.ask("act FIRE"), "reward")) += ",";
  std::string written;
  for (std::size_t at = 0; at < rewards.size();) {
    const std::string run = rewards.substr(at, rewards.find(',', at) - at);
    const std::size_t star = run.find('*');
    for (int times = star == run.npos ? 1 : std::stoi(run.substr(star + 1)); times > 0; --times)
      (written += run.substr(0, star)) += ",";
    at += run.size() + 1;
  }
  CHECK(written == expected);
}

TEST_CASE("A list of a branch that ends in a comma lacks an action") {
  Playing client("sticky=0");
  client.ask("save root");
  for (const std::string list : {"UP,", ",UP", "UP,,UP", ","})
    CHECK(code(client.ask("branch root " + list)) == "bad-action");
}

TEST_CASE("The ends of branches can be kept and gone on from") {
  Playing client("sticky=0");
  client.say("act FIRE*30\nsave root\n");
  CHECK(value(client.ask("branch root keep=leaf UP*5 DOWN*5"), "state", 2) == "leaf1");
  client.ask("restore leaf1");
  const std::string reply = client.ask("look ram screen:hex frame");
  client.say("restore root\nact DOWN*5\n");
  CHECK(client.ask("look ram screen:hex frame") == reply);
}

TEST_CASE("What a branch keeps has names that save takes, and needs room for new ones only") {
  LineLimits limits;
  limits.states = 3;
  Playing client("sticky=0", line_service(limits));
  client.ask("save root");
  CHECK(code(client.ask("branch root keep=" + std::string(64, 'a') + " UP")) == "bad-value");
  CHECK(code(client.ask("branch root keep=all DOWN")) == "");
  CHECK(client.ask("states") == "ok count=2 states=all0,root");
  const std::string longest(63, 'a');
  CHECK(code(client.ask("branch root keep=" + longest + " UP")) == "");
  CHECK(code(client.ask("restore " + longest + "0")) == "");
  CHECK(code(client.ask("branch root keep=" + longest + " DOWN*9")) == "");
  CHECK(code(client.ask("branch root keep=all UP DOWN")) == "limit");
  CHECK(value(client.ask("states"), "count") == "3");
}

TEST_CASE("A name of ten and more ends of a branch has a digit more") {
  Playing client("sticky=0");
  client.ask("save root");
  std::string lists;
  for (int list = 0; list < 11; ++list) lists += " UP";
  CHECK(code(client.ask("branch root keep=" + std::string(63, 'a') + lists)) == "bad-value");
  CHECK(client.ask("states") == "ok count=1 states=root");
  CHECK(code(client.ask("branch root keep=" + std::string(62, 'a') + lists)) == "");
}

TEST_CASE("Each of many machines plays as a single one with its seed") {
  LineService service = line_service();
  service.threads = 3;
  service.parallel = [](std::size_t count, const std::function<void(std::size_t)>& task) {
    std::vector<std::thread> threads;
    for (std::size_t number = 0; number < count; ++number) threads.emplace_back(task, number);
    for (std::thread& thread : threads) thread.join();
  };
  Playing many("sticky=0.25 frame_skip=3", service);
  many.ask("open 3");
  std::string last;
  for (int step = 0; step < 40; ++step) last = many.ask("step FIRE UP DOWN");
  const std::vector<std::string> actions = {"FIRE", "UP", "DOWN"};
  for (int machine = 0; machine < 3; ++machine) {
    LineClient one;
    one.ask("load beamfall sound=1 sticky=0.25 frame_skip=3 seed=" + std::to_string(7 + machine));
    one.ask(kEverything);
    std::string alone;
    for (int step = 0; step < 40; ++step)
      alone = one.ask("act " + actions[static_cast<std::size_t>(machine)]);
    for (const std::string key : {"reward", "lives", "frame", "ram", "screen", "grey84x4", "audio"})
      CHECK(value(last, key, machine + 1) == value(alone, key));
  }
}

TEST_CASE("Autoreset is Gymnasium's") {
  Playing client("sticky=0 max_episode_frames=2");
  client.ask("observe reward ends episode_frame ram");
  client.ask("reset");
  const std::string fresh = value(client.ask("look"), "ram");
  SECTION("next step") {
    client.ask("open 1");
    client.ask("step UP");
    CHECK(value(client.ask("step UP"), "truncated", 1) == "1");
    const std::string reset = client.ask("step UP");
    CHECK(value(reset, "truncated", 1) == "0");
    CHECK(value(reset, "episode_frame", 1) == "0");
    CHECK(value(client.ask("step UP"), "episode_frame", 1) == "1");
  }
  SECTION("same step") {
    client.ask("open 1 autoreset=same-step");
    client.ask("step UP");
    const std::string end = client.ask("step UP");
    CHECK(value(end, "truncated", 1) == "1");
    CHECK(value(end, "final_episode_frame", 1) == "2");
    CHECK(value(end, "episode_frame", 1) == "0");
    CHECK(value(end, "final_ram", 1) != value(end, "ram", 1));
    CHECK(value(end, "final_reward", 1) == "(none)");
    CHECK(value(client.ask("step UP"), "final_ram", 1) == "(none)");
  }
  SECTION("disabled") {
    client.ask("open 2 autoreset=disabled");
    client.say("step UP\nstep UP\n");
    CHECK(value(client.ask("step UP"), "episode_frame", 2) == "2");
    const std::string restarted = client.ask("restart 01");
    CHECK(value(restarted, "episode_frame", 1) == "2");
    CHECK(value(restarted, "truncated", 1) == "1");
    CHECK(value(restarted, "episode_frame", 2) == "0");
    CHECK(value(restarted, "truncated", 2) == "0");
    CHECK(code(client.ask("restart 011")) == "bad-arguments");
    CHECK(code(client.ask("restart 02")) == "bad-value");
  }
}

TEST_CASE("Many machines are opened and stepped in slices") {
  Playing client("sticky=0");
  client.ask("observe frame");
  const std::string requests = "open 40\nstep NOOP\n";
  std::ranges::copy(requests, client.session.space().begin());
  client.session.received(requests.size());
  CHECK(client.session.run(0us));
  CHECK(client.session.output().empty());
  CHECK(std::ranges::count(client.listen(), '|') == 80);
}

TEST_CASE("What is written into RAM is read there") {
  Playing client("sticky=0");
  CHECK(client.ask("poke 126 AB0F") == "ok index=126 bytes=AB0F");
  CHECK(client.ask("peek 126 2") == "ok index=126 bytes=AB0F");
  CHECK(client.ask("look ram").ends_with("AB0F"));
  for (const std::string request : {"poke 127 AB0F", "poke 128 00", "poke 0 A", "poke 0 XY", "peek 128",
                                    "peek -1", "peek 0 129", "peek 0 0"})
    CHECK(code(client.ask(request)) == "bad-value");
}

TEST_CASE("Fields that can't be given are refused") {
  LineClient client;
  client.ask("load beamfall");
  for (const std::string request :
       {"observe audio", "look audio", "look screen:delta", "look grey84x4", "observe lives lives",
        "observe ends terminated", "observe screen:", "observe lives:hex", "observe score",
        "observe screen:png", "observe screenx4", "observe grey84y4", "observe lives none"})
    CHECK(code(client.ask(request)) == "bad-arguments");
  CHECK(code(client.ask("observe grey84x17")) == "bad-value");
  CHECK(client.ask("observe") == "ok fields=reward,terminated,truncated,lives");
  CHECK(client.ask("observe none") == "ok fields=");
  CHECK(client.ask("act NOOP") == "ok");
}

TEST_CASE("A game without sound is not loaded while audio is observed") {
  LineClient client;
  client.ask("observe lives audio");
  CHECK(client.ask("load beamfall") ==
        "error bad-arguments observe selects audio, which needs sound=1; load with it, or observe other "
        "fields");
  CHECK(code(client.ask("act NOOP")) == "no-game");
  CHECK(code(client.ask("load beamfall sound=1")) == "");
  CHECK(code(client.ask("load updraft sound=0")) == "bad-arguments");
  CHECK(value(client.ask("settings"), "game") == "beamfall");
  client.ask("observe lives");
  CHECK(code(client.ask("load beamfall")) == "");
}

TEST_CASE("An episode that begins with no-ops begins differently, by the seed") {
  std::string frames;
  LineClient client;
  client.ask("load beamfall seed=9 sticky=0 noop_max=30");
  client.ask("observe episode_frame");
  for (int episode = 0; episode < 20; ++episode) frames += value(client.ask("reset"), "episode_frame") + " ";
  LineClient other;
  other.ask("load beamfall seed=9 sticky=0 noop_max=30");
  other.ask("observe episode_frame");
  std::string again;
  for (int episode = 0; episode < 20; ++episode) again += value(other.ask("reset"), "episode_frame") + " ";
  CHECK(frames == again);
  std::vector<std::string_view> words;
  split(frames, words);
  std::ranges::sort(words);
  const auto repeated =
      std::unique(words.begin(), words.end());  // clang 14 lacks what std::ranges::unique needs
  CHECK(words.end() - repeated < 12);           // more than eight different lengths
}

TEST_CASE("audio_all has the samples of each frame that a request ran, of at most 1000 frames") {
  LineClient client;
  client.ask("load beamfall seed=7 sticky=0 frame_skip=4 sound=1");
  client.ask("observe frames audio_all audio:hex");
  const auto samples = [&](const std::string& request) {
    return bytes_of_hex(value(client.ask(request), "audio_all"));
  };
  CHECK(samples("act FIRE*2").size() == std::size_t{2} * 4 * 512);
  CHECK(samples("reset").empty());
  CHECK(samples("act FIRE*250").size() > std::size_t{512} * 512);  // the game ends before the 1000 frames
  CHECK(client.ask("act FIRE*251") ==
        "error limit the request asks for audio_all of 1004 frames; it may ask for 1000");
  client.ask("load beamfall seed=7 sticky=0 frame_skip=2-5 sound=1");
  CHECK(code(client.ask("act FIRE*201")) == "limit");  // which may have 1005 frames
  const std::string reply = client.ask("act FIRE*200");
  const std::string all = value(reply, "audio_all");
  CHECK(all.size() == 1024 * std::stoul(value(reply, "frames")));
  CHECK(all.ends_with(value(reply, "audio")));
  client.ask("observe frames");
  CHECK(code(client.ask("act FIRE*201")) == "");
}

TEST_CASE("The palette gives a screen its colours, in each television standard") {
  for (const std::string game : {"duel", "duel_pal"}) {
    LineClient client(test::duel_service());
    client.ask("load " + game + " seed=7");
    const auto colours = bytes_of_hex(value(client.ask("look palette"), "palette"));
    REQUIRE(colours.size() == 768);
    const std::string reply = client.ask("look screen:hex rgb:hex");
    std::vector<std::uint8_t> rgb;
    for (const std::uint8_t pixel : bytes_of_hex(value(reply, "screen"))) {
      const auto* const colour = &colours[std::size_t{3} * pixel];
      rgb.insert(rgb.end(), colour, colour + 3);
    }
    const bool same = rgb == bytes_of_hex(value(reply, "rgb"));
    CHECK(same);
  }
}
