// log
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>

#include "protocol/encoding/base64.hpp"
#include "recording/phrase_seed.hpp"
#include "recording/recorder.hpp"
#include "tests/protocol/duel.hpp"
#include "tests/protocol/line_client.hpp"
#include "tests/protocol/record/recording_client.hpp"
#include "tests/recording/film.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using test::code;
using test::value;

namespace {

// Episodes of two acts.
const std::string kLoad = "load beamfall seed=7 sticky=0.25 frame_skip=2 max_episode_frames=4";
constexpr std::uint64_t kMemory = test::RecordingClient::kMemory;

struct Desk : test::RecordingClient {
  explicit Desk(std::size_t most_bytes = 1 << 30)
      : RecordingClient(test::duel_service(), kLoad, most_bytes) {}

  void play() {
    ask("reset");
    ask("act FIRE*2");
  }
  std::string seed() { return value(ask("settings"), "seed"); }
  bool has(const std::string& name) const { return std::filesystem::exists(folder.path(name)); }
};

}  // namespace

TEST_CASE("Episodes are logged from the next reset on, and seeds count up") {
  Desk desk;
  CHECK(desk.ask("log mine agent=still") == "ok log=mine unit=beamfall-still-1");
  desk.ask("act FIRE*2");  // of the episode that load began
  for (const char* const seed : {"8", "9"}) {
    desk.play();
    CHECK(desk.seed() == seed);
  }
  desk.ask("reset seed=4000");
  desk.ask("act FIRE*2");
  CHECK_THAT(desk.ask("log stop"), StartsWith("ok logged=3 unlogged=0 bytes=") && Contains(" complete=1"));
  const std::string table = desk.file("mine/results.csv");
  for (const char* const start : {"1,8,0,", "2,9,0,", "3,4000,0,"})
    CHECK_THAT(table, Contains(std::string("still,1,") + start));
  CHECK(desk.has("mine/logs/beamfall-still-1/3.episode"));
  CHECK_FALSE(desk.has("mine/logs/beamfall-still-1/4.episode"));
  desk.play();
  CHECK(desk.seed() == "4000");
  CHECK(code(desk.ask("log stop")) == "no-log");
}

TEST_CASE("settings has the seed of the episode that the end of another begins") {
  Desk desk;
  CHECK(code(desk.ask(kLoad + " autoreset=same-step")) == "");
  CHECK(code(desk.ask("log mine")) == "");
  desk.ask("reset");
  for (const char* const seed : {"8", "9", "10"}) {
    CHECK(desk.seed() == seed);
    desk.ask("act FIRE*2");
  }
  desk.ask("log stop");
  CHECK_THAT(desk.file("mine/results.csv"), Contains("agent,1,2,9,0,"));
}

TEST_CASE("An episode that something else than acts of player A changed has no log") {
  Desk desk;
  desk.ask("save before");
  desk.ask("log inline");
  CHECK_THAT(desk.ask("log last"),
             Contains("error no-log the last episode has no log: no episode has ended"));
  const std::map<std::string, std::string> spoilers = {
      {"poke 3 00", "poke wrote RAM in it"},
      {"set difficulty=0", "set changed it"},
      {"restore before", "a state was restored in it"},
      {"act NOOP/FIRE", "player B acted in it"},
      {"act NOOP\nreset", "it was left before its end"},
  };
  int unlogged = 0;
  for (const auto& [request, why] : spoilers) {
    INFO(request);
    desk.play();
    CHECK(code(desk.ask("log last")) == "");
    desk.ask("reset");
    desk.client.say(request + "\n");
    CHECK_THAT(desk.ask("log last"), Contains("error no-log the last episode has no log: " + why));
    desk.ask("act NOOP*2");
    ++unlogged;
  }
  CHECK(value(desk.ask("log stop"), "unlogged") == std::to_string(unlogged));
}

TEST_CASE("An episode with other settings than those of its log has no log") {
  Desk desk;
  desk.ask("log inline");
  desk.play();
  CHECK(code(desk.ask("log last")) == "");
  desk.ask("set difficulty=1");
  desk.play();
  CHECK_THAT(desk.ask("log last"), Contains("error no-log the last episode has no log: its settings are '") &&
                                       Contains(" difficulty=1") && Contains("'; those of the log are '") &&
                                       Contains(" difficulty=0"));
  desk.ask("set difficulty=0");
  desk.play();
  CHECK(code(desk.ask("log last")) == "");
  CHECK(value(desk.ask("log stop"), "logged") == "2");
}

TEST_CASE("Actions of the console are logged") {
  Desk desk;
  desk.ask("load beamfall seed=7 sticky=0 max_episode_frames=8 action_set=console");
  desk.ask("log inline");
  desk.ask("reset");
  desk.ask("act SELECT RESET*2 LEFT_A 25 NOOP*3");
  const std::string reply = desk.ask("log last");
  const auto bytes = *bytes_of_base64(value(reply, "data"));
  const EpisodeLog log = log_of("last", std::string(bytes.begin(), bytes.end()));
  CHECK(log.actions == std::vector<std::uint8_t>{19, 18, 18, 20, 25, 0, 0, 0});
  CHECK_THAT(log.settings, Contains(" action_set=console"));
}

TEST_CASE("Strengths of paddles are logged, and a log without them is as short as before") {
  Desk desk;
  desk.ask("load beamfall seed=7 sticky=0 max_episode_frames=8");
  desk.ask("log inline");
  const auto logged = [&](const char* acts) {
    desk.ask("reset");
    desk.ask(acts);
    const auto bytes = *bytes_of_base64(value(desk.ask("log last"), "data"));
    return log_of("last", std::string(bytes.begin(), bytes.end()));
  };
  const EpisodeLog turned = logged("act FIRE RIGHT@0.25 LEFT@-1e9*2 FIRE*4");
  CHECK(turned.strengths == std::vector<float>{1, 0.25F, -1e9F, -1e9F, 1, 1, 1, 1});
  CHECK(turned.strength(1) == 0.25F);
  const EpisodeLog plain = logged("act FIRE*8");
  CHECK(plain.strengths.empty());
  CHECK(plain.strength(1) == 1);
}

TEST_CASE("A log of an episode with strengths takes 400000 acts") {
  Desk desk;
  for (const bool fits : {true, false}) {
    desk.ask("load duel seed=7 sticky=0 max_episode_frames=" + std::to_string(fits ? 400'000 : 400'001));
    desk.ask("log inline");
    desk.ask("reset");
    desk.ask(fits ? "act FIRE@0.5*400000" : "act FIRE*400000 FIRE@0.5");
    const std::string last = desk.ask("log last");
    if (fits)
      CHECK_THAT(last, Contains(",400000,400000,truncated,"));
    else
      CHECK_THAT(last, Contains("has no log: it has more than 400000 acts with strengths"));
  }
}

TEST_CASE("branch and look do not change an episode's log") {
  Desk desk;
  desk.ask("log inline");
  desk.play();
  desk.ask("reset seed=9");
  desk.ask("act FIRE*2");
  const std::string undisturbed = value(desk.ask("log last"), "data");
  desk.ask("reset seed=9");
  desk.ask("save a");
  desk.ask("act FIRE");
  CHECK(code(desk.ask("branch a UP,UP DOWN")) == "");
  desk.ask("look screen");
  desk.ask("act FIRE");
  const std::string data = value(desk.ask("log last"), "data");
  CHECK(data != "(none)");
  CHECK(value(desk.ask("log stop"), "logged") == "3");
  // They differ in the number of the episode.
  CHECK(data.substr(0, 10) == undisturbed.substr(0, 10));
}

TEST_CASE("Seeds follow from a phrase, and another seed has no log") {
  Desk desk;
  desk.ask("log inline phrase=a_phrase trial=3");
  for (int episode = 1; episode <= 2; ++episode) {
    desk.play();
    CHECK(desk.seed() == std::to_string(seed_of_phrase("a phrase", "beamfall", 3, episode)));
  }
  desk.ask("reset seed=5");
  CHECK_THAT(desk.ask("log last"), Contains("its seed is 5; the phrase gives "));
}

TEST_CASE("An episode whose seed a replay cannot have has no log") {
  Desk desk;
  desk.ask("log inline");
  for (const std::string seed : {"0", "4294967295"}) {
    desk.ask("reset seed=" + seed);
    CHECK_THAT(desk.ask("log last"), Contains("its seed is " + seed + "; a log takes 1 to 4294967294"));
  }
  desk.play();
  CHECK(desk.seed() == "1");
  desk.ask("reset seed=4294967294");
  desk.ask("act FIRE*2");
  CHECK(code(desk.ask("log last")) == "");
  desk.play();
  CHECK(desk.seed() == "1");
  CHECK_THAT(desk.ask("log stop"), StartsWith("ok logged=3 unlogged=2 "));
}

TEST_CASE("The acts and strengths of an episode count as memory until the log is stopped") {
  constexpr std::uint64_t kBytes = 400 * (1 + sizeof(float));
  Desk desk;
  const auto taken = [&desk] { return desk.client.service.memory->taken(); };
  desk.ask("load beamfall seed=7 sticky=0 max_episode_frames=402");
  desk.ask("log inline");
  desk.ask("reset");
  desk.ask("act FIRE@0.5");
  const std::uint64_t at_start = taken();
  desk.ask("act FIRE@0.5*400");
  CHECK(taken() >= at_start + kBytes);
  CHECK(value(desk.ask("act FIRE@0.5"), "truncated") == "1");
  const std::uint64_t at_end = taken();
  CHECK(at_end >= at_start + kBytes);
  CHECK(value(desk.ask("log stop"), "logged") == "1");
  CHECK(taken() + kBytes <= at_end);
}

TEST_CASE("What ends the machine ends its log, which is kept") {
  const auto is_kept = [](const std::string& machine, const std::string& end) {
    Desk desk;
    desk.ask("open 2");
    desk.ask("log mine" + machine);
    desk.play();
    for (const char* const request : {"restart", "step FIRE", "step FIRE"}) desk.ask(request);
    desk.ask(end);
    const bool ended = code(desk.ask("log stop")) == "no-log";
    desk.client.service.recorder->end(std::chrono::seconds(10));
    return ended && desk.has("mine/logs/beamfall-agent-1/1.episode");
  };
  CHECK(is_kept("", kLoad));
  CHECK(is_kept(" machine=1", kLoad));
  CHECK(is_kept(" machine=1", "open 2"));
  CHECK(is_kept(" machine=0", "close"));
  CHECK_FALSE(is_kept("", "close"));
  CHECK_FALSE(is_kept(" machine=1", "open 2 autoreset=wrong"));
}

TEST_CASE("A limit ends the log once, and the session goes on") {
  Desk desk(8000);  // a log counts at least 4096
  desk.ask("log mine");
  std::string ended = "(none)";
  for (int episode = 0; episode < 100 && ended == "(none)"; ++episode) {
    desk.ask("reset");
    ended = value(desk.ask("act FIRE*2"), "log_ended");
  }
  CHECK(ended == "limit");
  desk.ask("reset");
  CHECK(value(desk.ask("act FIRE*2"), "log_ended") == "(none)");
  CHECK_THAT(desk.ask("log last"), Contains("has no log: the logs before it have reached a limit"));
  const std::string reply = desk.ask("log stop");
  CHECK(value(reply, "logged") == "1");
  CHECK(value(reply, "complete") == "0");
  CHECK(value(reply, "log_ended") == "limit");
  CHECK_FALSE(desk.has("mine/logs/beamfall-agent-1/2.episode"));
}

TEST_CASE("An invalid log is refused, and leaves nothing") {
  Desk desk;
  for (const std::string request : {"log", "log a b", "log a seed=1", "log a trial=1 trial=2", "log stop now",
                                    "log last 1", "log a agent"}) {
    INFO(request);
    CHECK(code(desk.ask(request)) == "bad-arguments");
  }
  const std::string much(65, 'a');
  for (const std::string& request : std::vector<std::string>{
           "log ../a", "log a/b", "log .a", "log " + much, "log a agent=../a",
           "log a agent=", "log a agent=" + much, "log a agent=..", "log a version=\"", "log a trial=0",
           "log a agent_seed=-1", "log a training_frames=x", "log a phrase=\"",
           "log a phrase=" + std::string(1001, 'a'), "log a role=hero", "log a link=ftp://x",
           "log a link=https://\"", "log a link=https://", "log a link=http://"}) {
    INFO(request);
    CHECK(code(desk.ask(request)) == "bad-value");
  }
  CHECK(code(desk.ask("log a machine=0")) == "no-machines");
  CHECK_THAT(desk.ask("log stop"),
             Contains("no-log no episodes are being logged; log NAME or log inline begins that"));
  CHECK(code(desk.ask("log last")) == "no-log");
  CHECK(test::files_in(desk.folder.path("")) == 0);
  CHECK(code(desk.ask("log a")) == "");
  CHECK_THAT(desk.ask("log b"), Contains("no-log episodes are logged already; log stop ends it"));
}

TEST_CASE("What nobody could play again is refused") {
  Desk desk;
  desk.ask("load beamfall height=220");
  CHECK_THAT(desk.ask("log a"),
             Contains("no-log an episode is played again with the properties of its image"));
  desk.ask(kLoad);
  desk.ask("open 1 steps=frames");
  CHECK_THAT(desk.ask("log a machine=0"), Contains("no-log a log has acts; open machines with steps=acts"));
  std::string sent = "load inline image=";
  append_base64(sent, std::vector<std::uint8_t>(*test::counter_image()->bytes));
  desk.ask(sent + " as=duel");
  CHECK(code(desk.ask("log inline")) == "");
}

TEST_CASE("Two sessions cannot log one unit, and a folder of pictures takes no logs") {
  Desk desk;
  test::LineClient other(desk.client.service);
  other.ask(kLoad);
  CHECK(code(desk.ask("log mine")) == "");
  CHECK(code(other.ask("log mine")) == "no-log");
  CHECK(code(other.ask("log mine trial=2")) == "");
  desk.ask("record png film");
  desk.play();
  desk.ask("record stop");
  desk.ask("log stop");
  CHECK_THAT(desk.ask("log film"),
             Contains("no-log film exists, and has no agent.toml; choose another name"));
}

TEST_CASE("A log and a recording cannot have one folder at the same time") {
  Desk desk;
  CHECK(code(desk.ask("log mine")) == "");
  CHECK_THAT(desk.ask("record png mine"), Contains("mine is being recorded already; choose another name"));
  CHECK(code(desk.ask("record png min")) == "");
  CHECK(code(desk.ask("record stop")) == "");
  CHECK(code(desk.ask("log stop")) == "");
  CHECK(code(desk.ask("record png film")) == "");
  CHECK_THAT(desk.ask("log film"), Contains("film/beamfall-agent-1 is being recorded already"));
}

TEST_CASE("A unit without episodes leaves no folder, and can be begun again") {
  Desk desk;
  desk.ask("log mine");
  CHECK_THAT(desk.ask("log stop"), StartsWith("ok logged=0 unlogged=0 "));
  CHECK_FALSE(desk.has("mine/logs/beamfall-agent-1"));
  CHECK(code(desk.ask("log mine")) == "");
}

TEST_CASE("A server without a folder hands logs over") {
  test::LineClient client;
  client.ask(kLoad);
  CHECK(code(client.ask("log mine")) == "no-log");
  CHECK(client.ask("log inline") == "ok log=inline unit=beamfall-agent-1");
  client.ask("reset");
  client.ask("act FIRE*2");
  const std::string reply = client.ask("log last");
  CHECK_THAT(reply, StartsWith("ok unit=beamfall-agent-1 episode=1 row=beamfall-agent-1,beamfall,"));
  CHECK_THAT(value(reply, "data"), StartsWith("UkJFUElTT0"));  // RBEPISOD
  CHECK(client.ask("log stop") == "ok logged=1 unlogged=0 complete=1");
}

TEST_CASE("A log that a reply or the memory has no room for is refused") {
  LineLimits limits;
  limits.reply = 300;
  test::LineClient client(test::line_service(limits));
  client.ask(kLoad);
  client.ask("log inline");
  client.ask("reset");
  client.ask("act FIRE*2");
  CHECK_THAT(client.ask("log last"), Contains("error limit a reply about a log would have about "));
  Desk desk;
  MemoryBudget& memory = *desk.client.service.memory;
  memory.take_anyway(kMemory - memory.taken() - (1 << 20));
  CHECK_THAT(desk.ask("log a"), Contains("error limit a log would take about "));
  CHECK(test::files_in(desk.folder.path("")) == 0);
}
