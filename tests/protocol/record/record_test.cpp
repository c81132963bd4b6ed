// record, shot
#include <catch2/catch.hpp>
#include <thread>

#include "protocol/encoding/base64.hpp"
#include "recording/recorder.hpp"
#include "tests/games/scratch.hpp"
#include "tests/protocol/line_client.hpp"
#include "tests/protocol/record/recording_client.hpp"
#include "tests/recording/film.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;
using test::code;
using test::value;

namespace {

const std::string kLoad = "load beamfall seed=7 sticky=0.25 frame_skip=2";
constexpr std::uint64_t kMemory = test::RecordingClient::kMemory;

struct Studio : test::RecordingClient {
  explicit Studio(std::size_t most_bytes = 1 << 30)
      : RecordingClient(test::line_service(), kLoad, most_bytes) {}
};

}  // namespace

TEST_CASE("Several kinds at once are what each is by itself") {
  Studio together, film, sound;
  CHECK(together.ask("record y4m,wav a") == "ok recording=a.y4m,a.wav");
  film.ask("record y4m a");
  sound.ask("record wav a");
  for (Studio* studio : {&together, &film, &sound}) {
    studio->ask("act FIRE*20 UP*5");
    CHECK(value(studio->ask("record stop"), "frames") == "50");
  }
  CHECK(film.file("a.y4m").size() > 50 * 3 * 320 * 210);
  CHECK((together.file("a.y4m") == film.file("a.y4m")));
  CHECK((together.file("a.wav") == sound.file("a.wav")));
}

TEST_CASE("A machine of open is recorded as one of its seed is") {
  Studio many, alone;
  many.ask("open 4 autoreset=disabled");
  CHECK(many.ask("record y4m,wav a machine=2") == "ok recording=a.y4m,a.wav");
  alone.ask("load beamfall seed=9 sticky=0.25 frame_skip=2");
  alone.ask("record y4m,wav a");
  many.ask("act NOOP*3");  // not of this machine
  for (int step = 0; step < 20; ++step) {
    many.ask(step % 3 == 0 ? "step FIRE UP LEFT RIGHT" : "step UP DOWN FIRE LEFT");
    alone.ask(step % 3 == 0 ? "act LEFT" : "act FIRE");
  }
  CHECK(value(many.ask("record stop"), "frames") == "40");
  CHECK(value(alone.ask("record stop"), "frames") == "40");
  CHECK((many.file("a.y4m") == alone.file("a.y4m")));
  CHECK((many.file("a.wav") == alone.file("a.wav")));
  many.ask("step FIRE");
  CHECK(code(many.ask("record stop")) == "recording");
}

TEST_CASE("A recording that was cut short is reported once, by act or step") {
  Studio studio(1'000'000);
  studio.ask("open 2");
  studio.ask("record y4m a");
  CHECK(value(studio.ask("act FIRE*20"), "recording_ended") == "limit");
  CHECK(value(studio.ask("act FIRE*20"), "recording_ended") == "(none)");
  CHECK(code(studio.ask("record y4m b")) == "recording");
  CHECK(studio.ask("record stop") ==
        "ok recorded=a.y4m frames=4 bytes=806463 complete=0 recording_ended=limit");
  CHECK(studio.file("a.y4m").size() == 806463);
  studio.ask("record y4m b machine=1");
  std::string reply = "(none)";
  int steps = 0;
  for (; reply == "(none)" && steps < 100; ++steps) reply = value(studio.ask("step FIRE"), "recording_ended");
  CHECK(reply == "limit");
  CHECK(value(studio.ask("step FIRE"), "recording_ended") == "(none)");
  CHECK(value(studio.ask("record stop"), "complete") == "0");
  studio.ask("record y4m c");
  CHECK(value(studio.ask("record stop"), "complete") == "1");
}

TEST_CASE("What ends the machine ends its recording, which is kept") {
  const auto is_kept = [](const std::string& record, const std::string& end) {
    Studio studio;
    studio.ask("open 2");
    CHECK_THAT(studio.ask(record), Contains("recording=a.wav"));
    studio.ask("act FIRE");
    studio.ask("step FIRE");
    studio.ask(end);
    const bool ended = code(studio.ask("record stop")) == "recording";
    studio.client.service.recorder->end(std::chrono::seconds(10));
    return ended && studio.file("a.wav").size() == 44 + 2 * 512;
  };
  CHECK(is_kept("record wav a", kLoad));
  CHECK(is_kept("record wav a machine=1", kLoad));
  CHECK(is_kept("record wav a machine=1", "open 2"));
  CHECK(is_kept("record wav a machine=0", "close"));
  CHECK(!is_kept("record wav a", "close"));
  CHECK(!is_kept("record wav a machine=1", "open 2 autoreset=wrong"));
}

TEST_CASE("A recording that memory does not suffice for is refused, and leaves nothing") {
  Studio studio;
  MemoryBudget& memory = *studio.client.service.memory;
  const std::uint64_t others = kMemory - memory.taken() - (1 << 20);
  memory.take_anyway(others);
  CHECK_THAT(studio.ask("record png,gif,y4m,wav a"), Contains("error limit a recording would take about "));
  CHECK(test::files_in(studio.folder.path("")) == 0);
  CHECK(code(studio.ask("act FIRE")) == "");
  memory.give_back(others);
  CHECK(studio.ask("record gif a") == "ok recording=a.gif");
}

TEST_CASE("What a recording holds is given back when it is written, after its session too") {
  Studio studio;
  const MemoryBudget& memory = *studio.client.service.memory;
  const std::uint64_t before = memory.taken();
  {
    test::LineClient other(studio.client.service);
    other.ask(kLoad);
    other.ask("record y4m,wav a");
    other.ask("act FIRE*4");
    CHECK(memory.taken() > before + (2 << 20));
  }
  studio.client.service.recorder->end(std::chrono::seconds(10));
  // Its last job is still to be released.
  for (int look = 0; look < 10'000 && memory.taken() != before; ++look)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(memory.taken() == before);
}

TEST_CASE("An invalid recording is refused, with what is accepted") {
  Studio studio;
  for (const std::string request :
       {"record", "record gif", "record avi a", "record gif, a", "record ,gif a", "record gif,gif a",
        "record gif a b", "record gif a machine", "record gif a seed=1", "record gif a machine=0 more"}) {
    INFO(request);
    CHECK(code(studio.ask(request)) == "bad-arguments");
  }
  CHECK(code(studio.ask("record gif a machine=0")) == "no-machines");
  studio.ask("open 2");
  CHECK_THAT(studio.ask("record gif a machine=2"),
             Contains("bad-value machine is '2'; it takes a whole number from 0 to 1"));
  CHECK(code(studio.ask("record gif ../a")) == "bad-value");
  CHECK(code(studio.ask("record stop")) == "recording");
  CHECK(test::files_in(studio.folder.path("")) == 0);
  CHECK(studio.ask("record gif a machine=1") == "ok recording=a.gif");
  CHECK_THAT(studio.ask("record gif b"), Contains("a.gif is still being recorded; record stop ends it"));
}

TEST_CASE("The frames that begin an episode are not recorded") {
  Studio studio;
  studio.ask("load beamfall seed=7 sticky=0 noop_max=30 autoreset=1 max_episode_frames=31");
  studio.ask("record wav a");
  for (const char* const request : {"reset", "reset", "reset seed=9", "reset"}) studio.ask(request);
  studio.ask("act FIRE");
  CHECK(value(studio.ask("record stop"), "frames") == "1");
  studio.ask("open 2");
  studio.ask("record wav b machine=1");
  for (const char* const request : {"restart", "step NOOP", "restart"}) studio.ask(request);
  CHECK(value(studio.ask("record stop"), "frames") == "1");
}

TEST_CASE("An act that begins the next episode tells, too, that the recording has ended") {
  Studio studio(1'000'000);
  studio.ask("load beamfall seed=7 sticky=0 autoreset=1 max_episode_frames=9");
  studio.ask("record y4m a");
  // A writer that meets the limit before the act has its reply is reported there.
  const std::string last = value(studio.ask("act FIRE*9"), "recording_ended");
  for (int look = 0; look < 10'000 && !studio.client.service.recorder->idle(); ++look)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::string next = value(studio.ask("act FIRE"), "recording_ended");
  CHECK((last == "limit") != (next == "limit"));
}

TEST_CASE("A shot is the frame that a recording of PNGs has") {
  Studio studio;
  studio.ask("record png film");
  studio.ask("act FIRE*20");
  const std::string reply = studio.ask("shot now");
  CHECK_THAT(reply, Contains("ok picture=now.png width=320 height=210 bytes="));
  studio.ask("record stop");
  const std::string picture = studio.file("now.png");
  CHECK((picture == studio.file("film/000039.png")));
  CHECK(value(reply, "bytes") == std::to_string(picture.size()));
  const std::string handed_over = studio.ask("shot");
  CHECK(value(handed_over, "bytes") == value(reply, "bytes"));
  const auto bytes = bytes_of_base64(value(handed_over, "data"));
  REQUIRE(bytes);
  CHECK((std::string(bytes->begin(), bytes->end()) == picture));
}

TEST_CASE("A server that keeps no files hands a shot over, whatever its name") {
  test::LineClient client;
  client.ask(kLoad);
  const std::string reply = client.ask("shot");
  CHECK(value(reply, "data").starts_with("iVBORw0KGgo"));
  CHECK(client.ask("shot now") == reply);
  client.ask("act FIRE*20");
  CHECK(client.ask("shot") != reply);
}

TEST_CASE("A shot of a machine of open shows that machine") {
  Studio studio;
  studio.ask("open 2");
  for (int step = 0; step < 9; ++step) studio.ask("step RIGHT LEFT");
  const auto data = [&studio](const std::string& request) { return value(studio.ask(request), "data"); };
  CHECK(data("shot machine=0") != data("shot machine=1"));
  CHECK(data("shot machine=0") != data("shot"));
  CHECK(studio.ask("shot machine=1 one").starts_with("ok picture=one.png"));
  const std::string file = studio.file("one.png");
  const auto bytes = bytes_of_base64(data("shot machine=1"));
  REQUIRE(bytes);
  CHECK((std::string(bytes->begin(), bytes->end()) == file));
}

TEST_CASE("An invalid shot is refused, with what is accepted") {
  Studio studio;
  CHECK_THAT(studio.ask("shot a b"), Contains("bad-arguments the name of the picture is given twice"));
  CHECK_THAT(studio.ask("shot a seed=1"),
             Contains("bad-arguments 'seed=1' is not accepted here; shot takes machine="));
  CHECK_THAT(studio.ask("shot ../a"), Contains("bad-value '../a' is not a name for a picture"));
  CHECK(code(studio.ask("shot a machine=0")) == "no-machines");
  studio.ask("open 2");
  CHECK_THAT(studio.ask("shot machine=2"), Contains("machine is '2'; it takes a whole number from 0 to 1"));
  CHECK(test::files_in(studio.folder.path("")) == 0);
  studio.ask("shot a");
  CHECK(studio.ask("shot a") == "error recording a.png exists; choose another name");
  test::LineClient without;
  CHECK(code(without.ask("shot")) == "no-game");
}

TEST_CASE("A shot above the limit of a recording is refused, and leaves nothing") {
  Studio studio(500);
  CHECK(studio.ask("shot a") == "error recording the picture is longer than a recording may be");
  CHECK(test::files_in(studio.folder.path("")) == 0);
  CHECK(studio.ask("shot").starts_with("ok width=320"));
}

TEST_CASE("A shot that a reply or the memory has no room for is refused") {
  LineLimits limits;
  limits.reply = 1000;
  test::LineClient client(test::line_service(limits));
  client.ask(kLoad);
  CHECK_THAT(client.ask("shot"), Contains("error limit a reply about a picture would have about "));
  Studio studio;
  MemoryBudget& memory = *studio.client.service.memory;
  memory.take_anyway(kMemory - memory.taken() - 1000);
  CHECK(code(studio.ask("shot")) == "limit");
  CHECK(code(studio.ask("shot a")) == "limit");
  CHECK(test::files_in(studio.folder.path("")) == 0);
}
