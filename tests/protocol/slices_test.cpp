// All work with frames is done in slices, can be cancelled, and counts against the limit.
#include <catch2/catch.hpp>

#include "protocol/encoding/encoding.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using namespace racebeam::test;
using namespace std::chrono_literals;

namespace {

// The number of slices of a request if each is as short as possible.
int slices_of(LineClient& client, const std::string& request, std::string& reply) {
  client.hand_in(request + "\n");
  int slices = 1;
  for (; client.session.run(0us); ++slices) {
    if (!client.session.output().empty()) break;
    REQUIRE(slices < 1'000'000);
  }
  reply = client.session.output();
  client.session.sent(reply.size());
  return slices;
}

// A session after `before`, and the number of slices of `request`.
int slices_after(const std::vector<std::string>& before, const std::string& request) {
  LineClient client;
  for (const std::string& line : before) REQUIRE(client.ask(line).starts_with("ok"));
  std::string reply;
  const int slices = slices_of(client, request, reply);
  INFO(reply);
  CHECK(reply.starts_with("ok"));
  return slices;
}

std::string many(const std::string& words) {
  std::string all;
  for (int n = 0; n < 20; ++n) all += words;
  return all;
}

const std::string kLong = "load beamfall seed=1 frame_skip=1000 max_episode_frames=0 noop_max=1000";

}  // namespace

TEST_CASE("Every command that runs frames is done in slices") {
  CHECK(slices_after({}, "load updraft seed=3 system_seed=77") > 10);
  CHECK(slices_after({}, kLong) > 50);
  CHECK(slices_after({kLong}, "act NOOP") > 50);  // also within one act
  CHECK(slices_after({kLong}, "reset") > 50);
  CHECK(slices_after({kLong}, "open 8") > 50);
  CHECK(slices_after({kLong, "save a"}, "branch a NOOP") > 50);
  CHECK(slices_after({kLong, "open 2"}, "step NOOP") > 50);
  CHECK(slices_after({kLong, "open 2"}, "restart") > 50);
  CHECK(slices_after({kLong, "open 2", "step NOOP", "step NOOP", "step NOOP", "step NOOP"}, "step NOOP") >
        50);
}

TEST_CASE("Slices change nothing") {
  LineClient whole, sliced;
  for (const std::string request :
       {"load beamfall seed=5 noop_max=30 frame_skip=7", "observe reward ends lives frame ram screen:rle",
        "act FIRE*40 LEFT", "save a random=1", "branch a keep=b UP*20 FIRE*30,LEFT", "restore b1",
        "open 5 autoreset=same-step", "step FIRE", "step UP", "restart 01010", "reset", "act RIGHT*100",
        "observe rgb160x210x4:rle rgb:zlib grey:delta", "act FIRE", "step UP", "act LEFT*30"}) {
    std::string reply;
    slices_of(sliced, request, reply);
    CHECK(whole.ask(request) + "\n" == reply);
  }
}

TEST_CASE("A cancelled request leaves no trace except the end of the session") {
  LineClient client;
  client.ask(kLong);
  client.hand_in("open 200\n");
  for (int n = 0; n < 20; ++n) REQUIRE(client.session.run(0us));
  client.session.cancel();
  CHECK_FALSE(client.session.run());
  CHECK(client.session.finished());
  CHECK(client.session.output().empty());
}

TEST_CASE("A line of many words is read in slices") {
  LineClient client;
  std::string line = "look";
  while (line.size() < 400'000) line += " 0";
  client.hand_in(line += '\n');
  int slices = 0;
  while (client.session.output().empty() && ++slices < 1000) client.session.run(0us);
  CHECK(slices > 100);
  CHECK(client.session.output().starts_with("error "));
}

TEST_CASE("Commands with very many words work on them in slices") {
  const auto repeated = [](const std::string& words) {
    std::string all;
    while (all.size() < 400'000) all += words;
    return all;
  };
  struct Case {
    std::string request, refusal;
    int least;  // slices; to read 200,000 words takes about 200
  };
  const std::vector<Case> cases = {{"drop" + repeated(" a"), "", 1500},
                                   {"branch a 0" + repeated(",0"), "", 700},
                                   {"branch a keep=k" + repeated(" 0"), "limit", 10'000}};
  for (const auto& [request, refusal, least] : cases) {
    INFO(request.substr(0, 20));
    LineClient client;
    for (const std::string line : {"load beamfall seed=1 max_episode_frames=0", "save a"}) client.ask(line);
    std::string reply;
    const int slices = slices_of(client, request, reply);
    CHECK(code(reply) == refusal);
    CHECK(slices >= least);
  }
}

TEST_CASE("Long values are written in slices") {
  for (const EncodingRow& row : encodings()) {
    INFO(row.name);
    const std::string stack = " rgb160x210x16:" + std::string(row.name);
    // A stack has 1.6 million bytes. Of 15 pictures that are still black, runs and delta write little.
    const int least = row.encoding == Encoding::kDelta || row.encoding == Encoding::kRunLength ? 3 : 30;
    CHECK(slices_after({kLoad, "observe" + stack}, "act NOOP") > least);
    CHECK(slices_after({kLoad, "observe" + stack, "open 2"}, "step NOOP") > least);
    if (least > 3)
      CHECK(slices_after({kLoad, "observe" + stack, "open 1", "save a machine=0"}, "restore a machine=0") >
            least);
  }
  CHECK(slices_after({kLoad}, "look rgb") > 2);
}

TEST_CASE("Many lists of a branch that end at once are played in slices") {
  std::string lists;
  for (int n = 0; n < 20'000; ++n) lists += " 0";
  CHECK(slices_after({kLoad + " max_episode_frames=1", "act NOOP", "save over"}, "branch over" + lists) >
        39'000);
}

TEST_CASE("What is there twice is refused before the words that follow it are read") {
  LineClient client;
  client.ask("load beamfall");
  CHECK(client.ask("look ram ends ram nonsense") == "error bad-arguments the field ram is given twice");
  CHECK(client.ask("load beamfall sticky=0 sticky=0 nonsense=1") ==
        "error bad-arguments sticky is given twice");
}

TEST_CASE("A pause in the middle of a request takes nothing that it needs") {
  for (const std::string& request : {"act" + many(" LEFT*40 FIRE*30 RIGHT"),
                                     "branch root" + many(" LEFT*40 FIRE*30"), "step" + many(" LEFT FIRE")}) {
    LineClient whole, resting;
    for (LineClient* const client : {&whole, &resting}) {
      for (const std::string line :
           {"load beamfall seed=1 max_episode_frames=0 frame_skip=4", "save root", "open 40"})
        REQUIRE(client->ask(line).starts_with("ok"));
    }
    resting.hand_in(request + "\n");
    while (resting.session.run(0us) && resting.session.output().empty()) resting.session.release_caches();
    const std::string reply(resting.session.output());
    CHECK(reply.starts_with("ok"));
    CHECK(reply == whole.ask(request) + "\n");
  }
}

TEST_CASE("A session may end while a request is in progress") {
  for (const std::string request : {"open 50", "act NOOP*1000", "reset", "load updraft noop_max=1000"}) {
    LineClient client;
    client.ask(kLong);
    client.hand_in(request + "\n");
    for (int n = 0; n < 5; ++n) REQUIRE(client.session.run(0us));
  }
}

TEST_CASE("Frames of load, open, reset, restart and step count against the limit") {
  LineLimits limits;
  limits.request_frames = 5000;
  LineClient client(line_service(limits));
  client.ask("load updraft seed=1");
  const std::string before = client.ask("settings");
  CHECK(code(client.ask("load beamfall as=adventure mode=1 frame_skip=1000 max_episode_frames=0")) != "");
  CHECK(client.ask("settings") == before);
  CHECK(client.ask("load beamfall seed=1 frame_skip=200 noop_max=900 max_episode_frames=0 sticky=0")
            .starts_with("ok"));
  CHECK(code(client.ask("act NOOP*26")) == "limit");
  CHECK(client.ask("open 2 autoreset=disabled").starts_with("ok"));
  CHECK(client.ask("step NOOP").starts_with("ok"));
  const std::string machines = client.ask("step NOOP");
  CHECK(client.ask("open 25 autoreset=disabled").starts_with("ok"));
  CHECK(client.ask("step NOOP").starts_with("ok"));
  CHECK(client.ask("open 26 autoreset=disabled").starts_with("ok"));
  CHECK(code(client.ask("step NOOP")) == "limit");  // 26 acts of 200 frames
  CHECK(value(client.ask("restart 1" + std::string(25, '0')), "machines") == "26");
}

TEST_CASE("load, reset and open beyond the frames of a request leave what is there") {
  LineClient client;
  const std::string load = "load beamfall noop_max=1000 seed=";
  client.ask(load + "1");
  client.ask("observe episode_frame");
  int seed = 1;  // with so many no-ops that the reset has more frames than are free, 1000
  while (std::stoi(value(client.ask("reset seed=" + std::to_string(seed)), "episode_frame")) < 950)
    REQUIRE(++seed < 1000);
  CHECK(code(client.ask("open 1 autoreset=disabled")) == "");
  const std::string settings = client.ask("settings");
  client.service.limits.request_frames = 1;
  for (const std::string& request :
       {std::string("open 1"), "reset seed=" + std::to_string(seed), load + std::to_string(seed)}) {
    INFO(request);
    CHECK(client.ask(request) ==
          "error limit the request would run more than 1001 frames; powering on, reaching a mode and "
          "no-ops count, too");
    CHECK(client.ask("settings") == settings);
    CHECK(value(client.ask("step NOOP"), "machines") == "1");
  }
  CHECK(code(client.ask("reset seed=1")) == "");
  CHECK(code(client.ask("open 100")) == "");  // 1,000 frames a machine are free
}
