#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "protocol/line/watching.hpp"
#include "tests/protocol/duel.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using namespace racebeam::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

using namespace std::chrono_literals;

// Clients of one server.
struct Server {
  LineService service = line_service();
  LineClient player{service}, watcher{service};

  explicit Server(LineService with = line_service()) : service(std::move(with)) {}

  void share() {
    player.ask(kLoad);
    CHECK(player.ask("share room") == "ok share=room watchers=1000");
  }
  // Waits until the last copy is so old that the next request may make another.
  void wait_until_due() const {
    const auto share = service.shares->find("room");
    while (!share->is_due(Snapshot::Clock::now())) std::this_thread::yield();
  }
  // What the watcher sees after the player's request, once it has been published.
  std::string seen_after(const std::string& request, const std::string& fields = "") {
    watcher.ask("watch room");
    wait_until_due();
    player.ask(request);
    return watcher.ask("watch room" + fields);
  }
};

}  // namespace

TEST_CASE("A watcher sees what the player's machine shows") {
  Server server;
  server.share();
  CHECK(server.watcher.ask("watch room") ==
        "ok game=beamfall frame=0 score=0 episode=1 over=0 lives=4 reward=0 action=NOOP height=210");
  const std::string reply = server.seen_after("act FIRE*60", " screen:hex ram palette:zlib");
  CHECK_THAT(reply,
             StartsWith("ok game=beamfall frame=60 score=21 episode=1 over=0 lives=4 reward=21 action=FIRE "
                        "height=210 screen="));
  const std::string look = server.player.ask("look screen:hex ram palette:zlib");
  for (const std::string key : {"screen", "ram", "palette"}) {
    CHECK(value(look, key) != "(none)");
    CHECK(value(reply, key) == value(look, key));
  }
}

TEST_CASE("The score is that of the episode, also after a restore") {
  Server server;
  server.share();
  CHECK(value(server.seen_after("act FIRE*60"), "score") == "21");
  server.player.ask("save here");
  CHECK(value(server.seen_after("act FIRE*60"), "score") == "36");
  CHECK(value(server.seen_after("restore here"), "score") == "21");
  CHECK(value(server.seen_after("reset"), "score") == "0");
  server.player.ask("load beamfall seed=7 sticky=0 max_episode_frames=4");
  const std::string over = server.seen_after("act NOOP*9");
  CHECK(value(over, "over") == "1");
  CHECK(value(over, "episode") == "1");
  CHECK(value(server.seen_after("reset"), "episode") == "2");
}

TEST_CASE("Episodes are counted on the machine that is shared") {
  Server server;
  server.share();
  server.player.say(
      "load beamfall seed=7 sticky=0 max_episode_frames=1\nopen 4 autoreset=disabled\nstep 0\n");
  CHECK(value(server.seen_after("look"), "episode") == "1");
  server.player.say("act 0\nsave over\nreset\n");
  CHECK(value(server.seen_after("reset"), "episode") == "3");  // also without an end before
  CHECK(value(server.seen_after("restore over"), "episode") == "3");
  server.player.ask("load beamfall seed=7");
  CHECK(value(server.seen_after("restore over"), "episode") == "1");
}

TEST_CASE("The action shown is the last one that was played") {
  Server server;
  server.share();
  server.player.ask("act RIGHT*3");
  CHECK(value(server.seen_after("act LEFT 99"), "action") == "RIGHT");
  server.player.say("load beamfall seed=7 max_episode_frames=1\nact RIGHT\n");
  CHECK(value(server.seen_after("act LEFT"), "action") == "RIGHT");  // the episode is over
  server.player.session.release_caches();
  CHECK(value(server.seen_after("settings"), "action") == "RIGHT");
  CHECK(value(server.seen_after("load beamfall"), "action") == "NOOP");
}

TEST_CASE("A session can replace its own share under the same name") {
  Server server;
  server.share();
  CHECK(server.player.ask("share room watchers=4") == "ok share=room watchers=4");
  CHECK(code(server.player.ask("share room watchers=0")) == "bad-value");
  CHECK_THAT(server.watcher.ask("watch room"), StartsWith("ok game=beamfall"));
  server.watcher.ask("load beamfall");
  CHECK(code(server.watcher.ask("share room")) == "bad-value");
}

TEST_CASE("A session that replaces its own share keeps its name, whoever else asks for it") {
  Server server;
  server.share();
  server.watcher.ask(kLoad);
  std::atomic<bool> stop = false, taken = false;
  std::thread other([&] {
    while (!stop && !taken) taken = server.watcher.ask("share room") == "ok share=room watchers=1000";
  });
  for (int times = 0; times < 20'000 && !taken; ++times) server.player.say("share room watchers=4\n");
  stop = true;
  other.join();
  CHECK_FALSE(taken);
  CHECK(code(server.watcher.ask("share room")) == "bad-value");
}

TEST_CASE("A share that is not the one of its name leaves that one alone") {
  const auto shares = std::make_shared<Shares>();
  const auto first = Sharing::open(shares, "one", 1);
  CHECK(Sharing::open(shares, "one", 1) == nullptr);
  CHECK(shares->find("one").get() == &first->share());
}

TEST_CASE("A watcher without news gets no picture") {
  Server server;
  server.share();
  CHECK_THAT(server.watcher.ask("watch room since=0 screen"), !Contains("screen="));
  CHECK_THAT(server.watcher.ask("watch room since=1 screen"), Contains("screen="));
  CHECK_THAT(server.watcher.ask("watch room screen:raw"), Contains(" screen=33600 raw=33600\n"));
}

TEST_CASE("A watcher sees the colours of the game's television standard") {
  Server server(duel_service());
  for (const std::string game : {"duel", "duel_pal"}) {
    server.player.ask("load " + game);
    server.player.ask("share " + game);
    CHECK(value(server.watcher.ask("watch " + game + " palette:hex"), "palette") ==
          value(server.player.ask("look palette:hex"), "palette"));
  }
}

TEST_CASE("Delta is relative to the last reply with the same fields") {
  Server server;
  server.share();
  const std::string whole = value(server.watcher.ask("watch room screen:delta"), "screen");
  CHECK(value(server.watcher.ask("watch room screen:delta"), "screen").empty());
  CHECK(value(server.watcher.ask("watch room screen:delta ram"), "screen") == whole);
  CHECK(value(server.watcher.ask("watch room screen:delta"), "screen") == whole);
}

TEST_CASE("Delta goes on where a name is shared anew, as the watcher's array does") {
  Server server;
  server.share();
  server.watcher.ask("watch room screen:delta");
  server.player.ask("unshare");
  CHECK(code(server.watcher.ask("watch room screen:delta")) == "bad-value");
  server.player.ask("share room");
  CHECK(value(server.watcher.ask("watch room screen:delta"), "screen").empty());
}

TEST_CASE("Delta begins anew where the screen has another height") {
  Watched watched;
  const auto fields = parse_watched_fields(std::array<std::string_view, 1>{"screen:delta"});
  const auto picture_of = [&](std::size_t height) {
    Snapshot snapshot;
    snapshot.screen.assign(height * kScreenWidth, 2);
    std::string out, raw;
    watched.append(out, raw, fields, snapshot);
    return out;
  };
  const std::string whole = picture_of(210);
  CHECK(picture_of(210) == " screen=");
  const std::string taller = picture_of(250);
  CHECK(taller.size() > whole.size());
  CHECK(picture_of(210) == whole);
  CHECK(picture_of(250) == taller);
}

TEST_CASE("A copy is made only after a watcher has asked") {
  Server server;
  server.share();
  server.player.ask("act UP");
  server.wait_until_due();
  server.player.ask("act UP");
  CHECK(value(server.watcher.ask("watch room"), "frame") == "0");
  server.player.ask("act UP");
  CHECK(value(server.watcher.ask("watch room"), "frame") == "3");
}

TEST_CASE("A session that pauses shows where it stopped") {
  Server server;
  server.share();
  server.player.ask("act UP*5");
  server.player.session.release_caches();
  CHECK(value(server.watcher.ask("watch room"), "frame") == "5");
}

TEST_CASE("Shared sessions are listed until they end") {
  Server server;
  CHECK(server.watcher.ask("shared") == "ok count=0");
  server.share();
  CHECK(server.watcher.ask("shared") ==
        "ok count=1 | name=room game=beamfall frame=0 score=0 episode=1 fps=0");
  CHECK(server.player.ask("unshare") == "ok");
  CHECK(server.watcher.ask("shared") == "ok count=0");
  CHECK_THAT(server.watcher.ask("watch room"), StartsWith("error bad-value unknown shared session 'room';"));
  {
    LineClient other(server.service);
    other.ask(kLoad);
    other.ask("share room");
    CHECK_THAT(server.watcher.ask("watch rom"), Contains("did you mean room?"));
    CHECK_THAT(server.watcher.ask("watch room"), StartsWith("ok "));
  }
  CHECK_THAT(server.watcher.ask("watch room"), StartsWith("error bad-value "));
}

TEST_CASE("share and watch refuse what they cannot do") {
  Server server;
  CHECK_THAT(server.player.ask("share room"), StartsWith("error no-game "));
  server.share();
  LineClient other(server.service);
  other.ask(kLoad);
  CHECK(other.ask("share room") ==
        "error bad-value another session is shared as 'room'; choose another name");
  for (const auto& name : std::vector<std::string>{"a/b", "a=b", "\"", std::string(65, 'a')})
    CHECK_THAT(other.ask("share " + name), StartsWith("error bad-value the name "));
  CHECK_THAT(other.ask("share " + std::string(64, 'a') + " watchers=1"), StartsWith("ok "));
  CHECK_THAT(other.ask("share b watchers=0"), StartsWith("error bad-value watchers "));
  CHECK_THAT(server.watcher.ask("watch room lives"),
             StartsWith("error bad-arguments watch does not show lives"));
  CHECK_THAT(server.watcher.ask("watch room screen screen"), StartsWith("error bad-arguments "));
  CHECK_THAT(server.watcher.ask("watch room since=x"), StartsWith("error bad-value since "));
}

TEST_CASE("A shared session has as many watchers as its client allows") {
  Server server;
  server.player.ask(kLoad);
  server.player.ask("share room watchers=1");
  CHECK_THAT(server.watcher.ask("watch room"), StartsWith("ok "));
  CHECK_THAT(server.watcher.ask("watch room"), StartsWith("ok "));
  {
    LineClient other(server.service);
    CHECK(other.ask("watch room") == "error limit room has 1 watchers, the most that it allows");
  }
  server.player.ask("share room2 watchers=1");
  LineClient other(server.service);
  CHECK_THAT(other.ask("watch room2"), StartsWith("ok "));
}

TEST_CASE("A shared session may have one watcher to a million") {
  Server server;
  server.share();
  CHECK(server.player.ask("share room watchers=1") == "ok share=room watchers=1");
  CHECK(server.player.ask("share room watchers=1000000") == "ok share=room watchers=1000000");
  CHECK(server.player.ask("share room watchers=1000001") ==
        "error bad-value watchers is '1000001'; it takes a whole number from 1 to 1000000");
}

TEST_CASE("A session may watch 256 shared sessions, and one that has ended leaves room for another") {
  Server server;
  std::vector<std::unique_ptr<Sharing>> shared;
  const auto watch = [&](int number) {
    return server.watcher.say("watch s" + std::to_string(number) + "\n");
  };
  for (int number = 0; number <= 256; ++number) {
    shared.push_back(Sharing::open(server.service.shares, "s" + std::to_string(number), 1));
    shared.back()->share().publish({}, 0);
    if (number < 256) REQUIRE_THAT(watch(number), StartsWith("ok "));
  }
  CHECK(watch(256) == "error limit a session may watch 256 shared sessions\n");
  CHECK_THAT(watch(0), StartsWith("ok "));
  shared[7].reset();
  CHECK_THAT(watch(256), StartsWith("ok "));
  CHECK_THAT(watch(7), StartsWith("error bad-value unknown shared session 's7';"));
}

TEST_CASE("The list of shared sessions has their frames a second, as whole numbers") {
  Server server;
  const auto shared = Sharing::open(server.service.shares, "room", 1);
  Share& share = shared->share();
  share.publish({}, 0);
  while (share.newest()->fps == 0) share.publish({}, 1000);
  std::string fps;
  const auto limit = std::chrono::steady_clock::now() + 60s;
  const auto expected = [&] { return std::to_string(std::llround(share.newest()->fps)); };
  do {  // once more where the processor was away for longer than a session pauses
    share.publish({}, 1000);
    fps = value(server.watcher.say("shared\n"), "fps", 1);
    fps = fps.substr(0, fps.find('\n'));
  } while (fps != expected() && std::chrono::steady_clock::now() < limit);
  CHECK(fps == expected());
}

TEST_CASE("A server can share all sessions") {
  LineService service = line_service();
  service.share_all = true;
  Server server(service);
  server.player.ask(kLoad);
  server.watcher.ask(kLoad);
  CHECK_THAT(server.watcher.ask("shared"),
             Contains("count=2 | name=session-1 ") && Contains(" name=session-2 "));
  server.player.ask("share mine");
  CHECK_THAT(server.watcher.ask("shared"), Contains("name=mine ") && Contains(" name=session-2 "));
  CHECK_THAT(server.player.ask("unshare"), StartsWith("error bad-value "));
}

TEST_CASE("Watchers in other threads see whole pictures of a session that plays") {
  Server server;
  server.share();
  const std::string first = value(server.watcher.ask("watch room screen:hex"), "screen");
  std::atomic<bool> stop = false;
  std::atomic<int> newer = 0;
  std::vector<std::thread> threads;
  for (int n = 0; n < 3; ++n) {
    threads.emplace_back([&] {
      LineClient watcher(server.service);
      std::string frame = "0";
      while (!stop) {
        const std::string reply = watcher.ask("watch room since=" + frame + " screen:hex");
        if (reply.find(" screen=") == std::string::npos) continue;
        if (value(reply, "screen").size() != first.size()) break;
        if (value(reply, "frame") != frame) ++newer;
        frame = value(reply, "frame");
        watcher.ask("shared");
      }
    });
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto past = [&] { return std::chrono::steady_clock::now() - begin; };
  while (past() < 500ms || (newer <= 10 && past() < 20s)) {  // longer where threads wait for processors
    server.player.ask("act RIGHT*5 LEFT*5 FIRE");
    if (server.player.ask("look terminated") == "ok terminated=1") server.player.ask("reset");
  }
  stop = true;
  for (std::thread& thread : threads) thread.join();
  CHECK(newer > 10);
}
