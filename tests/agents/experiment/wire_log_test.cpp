// Submissions that `log` of the line protocol leaves.
#include <catch2/catch.hpp>

#include "agents/experiment/verify_submission.hpp"
#include "protocol/encoding/base64.hpp"
#include "recording/recorder.hpp"
#include "tests/agents/experiment/verified.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace fs = std::filesystem;

namespace {

const std::string kLoadSticky = "load beamfall seed=7 sticky=0.25 frame_skip=5 max_episode_frames=3000 ";

struct Server {
  Server() {
    service.recorder = std::make_shared<Recorder>(place.path(""));
    service.version = "0.1.0";
  }
  ResultsFolder folder(const std::string& name = "mine") const { return ResultsFolder(place.path(name)); }

  Scratch place;
  LineService service = line_service();
};

Verified of_submission(const ResultsFolder& folder) {
  Verified result;
  result.verdict = verify_submission(folder, Images(), 2, CpuKind::kAuto,
                                     [&](const std::string& line) { result.findings += line + "\n"; });
  return result;
}

void check_confirmed(const ResultsFolder& folder, std::size_t rows) {
  const Verified found = of_submission(folder);
  INFO(found.findings);
  CHECK(found.verdict.confirmed == rows);
  CHECK(found.verdict.wrong == 0);
}

// Ends the session, whose logs then lie there.
void check_confirmed(Server& server, const std::string& conversation, std::size_t rows,
                     const std::string& name = "mine") {
  LineClient client(server.service);
  const std::string replies = client.say(conversation + "\n"), ended = client.ask("log stop");
  INFO(replies);
  CHECK(replies.find("error ") == std::string::npos);
  CHECK(value(ended, "complete") == "1");
  check_confirmed(server.folder(name), rows);
}

const std::string kThree =
    "log mine agent=still agent_seed=5\nreset\nact FIRE*9 RIGHT*2000\nreset\nact FIRE*9 LEFT*2000\nreset\n"
    "act UPFIRE*2000";

}  // namespace

TEST_CASE("A session's log is confirmed, and every alteration is refused") {
  Server server;
  check_confirmed(server, kLoadSticky + "\n" + kThree, 3);
  const ResultsFolder folder = server.folder();
  const std::string table = contents(folder.results());
  CHECK(contents(folder.root() + "/agent.toml") ==
        "agent = \"still\"\nversion = \"1\"\npreset = \"other\"\ntraining_frames = 0\n");
  const auto refused = [&](const std::string& sentence) {
    const Verified found = of_submission(folder);
    CHECK(found.verdict.wrong >= 1);
    CHECK_THAT(found.findings, Catch::Contains(sentence));
  };
  SECTION("a score raised by one in the row") {
    const std::string score = field(rows_of(table)[0], "score");
    write(folder.results(), altered_field(table, 0, 8, std::to_string(std::stoi(score) + 1)));
    refused("not confirmed: score is ");
  }
  SECTION("a score raised by one in the row and its log") {
    reseal(folder, 0, [](EpisodeLog& log) { ++log.end.score; });
    refused("not confirmed: score is ");
  }
  SECTION("an action that was changed") {
    reseal(folder, 0, [](EpisodeLog& log) { log.actions.back() = log.actions.back() == 4 ? 3 : 4; });
    refused("results.csv:2 (beamfall-still-1, episode 1): not confirmed: ");
  }
  SECTION("a swapped seed") {
    const EpisodeLog other = log_of("2.episode", contents(folder.log("beamfall-still-1", "2")));
    reseal(folder, 0, [&](EpisodeLog& log) { log.settings = other.settings; });
    refused("results.csv:2 (beamfall-still-1, episode 1): not confirmed: ");
  }
  SECTION("a seed that is swapped in the row") {
    write(folder.results(), altered_field(table, 0, 6, field(rows_of(table)[1], "environment_seed")));
    refused("not confirmed: environment_seed is ");
  }
}

TEST_CASE("Every setting of play that a log can repeat is confirmed") {
  const std::string five = "frame_skip=5 ";
  for (const std::string& settings :
       {std::string("preset=paper2013"), std::string("preset=machado2018"), five + "noop_max=30 difficulty=1",
        five + "life_loss=end", five + "life_loss=restart", five + "life_loss=reported",
        five + "life_loss_ends=1", five + "autoreset=same-step", five + "autoreset=next-step",
        std::string("frame_skip=3-6 reward_min=-1 reward_max=1 action_set=minimal"),
        five + "color_averaging=1 sound=1 rules=fixed system_seed=9 action_set=legal"}) {
    INFO(settings);
    Server server;
    LineClient client(server.service);
    client.ask("load beamfall seed=7 sticky=0.25 max_episode_frames=3000 " + settings);
    REQUIRE(client.ask("log mine").starts_with("ok "));
    // Episodes of 600 acts at most, or of five lives.
    for (int act = 0; act < 12; ++act) {
      client.ask("reset");
      client.ask("act FIRE*20 RIGHT*800");
    }
    const std::string reply = client.ask("log stop");
    INFO(reply);
    const std::string logged = value(reply, "logged");
    CHECK(logged != "0");
    check_confirmed(server.folder(), static_cast<std::size_t>(std::stoi(logged)));
  }
}

TEST_CASE("A log with strengths of a paddle is confirmed") {
  Server server;
  check_confirmed(server, kLoadSticky + "\nlog mine\nreset\nact FIRE*9 RIGHT@0.3*1000 LEFT@-7*1000", 1);
  const ResultsFolder folder = server.folder();
  CHECK(log_of("1", contents(folder.log("beamfall-agent-1", "1"))).strength(9) == 0.3F);
}

TEST_CASE("One of the machines of open leaves a log that is confirmed") {
  for (const std::string options :
       {"\nopen 3", "\nopen 3 autoreset=same-step", "\nopen 3 autoreset=disabled",
        "\nopen 3 life_loss=restart", "\nopen 3 life_loss=end autoreset=same-step",
        "life_loss_ends=1\nopen 3", "life_loss_ends=1\nopen 3 life_loss=ignored"}) {
    INFO(options);
    Server server;
    std::string conversation = kLoadSticky + options + "\nlog mine machine=1\nrestart";
    for (int step = 0; step < 1300; ++step)
      conversation += step == 650 ? "\nrestart" : "\nstep FIRE RIGHT UP";
    LineClient client(server.service);
    client.say(conversation + "\n");
    const std::string logged = value(client.ask("log stop"), "logged");
    CHECK(logged != "0");
    check_confirmed(server.folder(), static_cast<std::size_t>(std::stoi(logged)));
  }
}

TEST_CASE("A folder takes the units of several sessions, games and trials") {
  Server server;
  const std::string other =
                        "load updraft seed=7 sticky=0.25 frame_skip=5 max_episode_frames=3000 difficulty=0\n",
                    play = "\nreset\nact FIRE*9 RIGHT*2000";
  check_confirmed(server, kLoadSticky + "\n" + kThree, 3);
  check_confirmed(server, kLoadSticky + "\nlog mine agent=still trial=2" + play, 4);
  check_confirmed(server, other + "log mine agent=still" + play, 5);
  LineClient client(server.service);
  client.ask(kLoadSticky);
  CHECK(client.ask("log mine agent=still") ==
        "error no-log mine has the unit beamfall-still-1 already; another trial= makes another");
  CHECK(client.ask("log mine agent=other") ==
        "error no-log mine has another agent.toml; choose another name, or the same words");
  client.ask("load beamfall seed=7 frame_skip=4");
  CHECK_THAT(client.ask("log mine agent=still trial=3"),
             Catch::StartsWith("error no-log the logs of mine have the settings '"));
  check_confirmed(server.folder(), 5);
}

TEST_CASE("With a phrase, the session's seeds follow from it") {
  Server server;
  check_confirmed(
      server, kLoadSticky + "\nlog mine phrase=the_first_headline\nreset\nact FIRE*999\nreset\nact UP*999",
      2);
  CHECK_THAT(contents(server.folder().root() + "/agent.toml"),
             Catch::Contains("phrase = \"the first headline\"\n"));
}

TEST_CASE("log last hands over the file") {
  Server server;
  LineClient client(server.service);
  client.say(kLoadSticky + "\n" + kThree + "\n");
  const std::string reply = client.ask("log last");
  client.ask("log stop");
  const ResultsFolder folder = server.folder();
  const auto bytes = bytes_of_base64(value(reply, "data"));
  REQUIRE(bytes);
  CHECK((std::string(bytes->begin(), bytes->end()) == contents(folder.log("beamfall-still-1", "3"))));
  CHECK_THAT(contents(folder.results()), Catch::EndsWith("\n" + value(reply, "row") + "\n"));
}
