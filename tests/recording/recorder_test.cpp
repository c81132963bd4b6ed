#include "recording/recorder.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "tests/games/scratch.hpp"
#include "tests/recording/film.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kMuch = 1 << 30;

void wait(const Recording& recording) {
  while (recording.is_behind()) std::this_thread::yield();
}

void add(Recording& recording, Environment& machine, int frames) {
  for (; frames > 0; --frames) {
    machine.act(frames % 18);
    wait(recording);
    recording.add(machine);
  }
}

}  // namespace

TEST_CASE("A recording that is released is committed all the same") {
  const Scratch folder;
  Environment machine = test::beamfall();
  {
    Recorder recorder(folder.path(""));
    add(*recorder.begin({MediaKind::kWav}, "a", kMuch, machine), machine, 40);
  }
  CHECK(test::read(folder.path("a.wav")).size() == 44 + 40 * 512);
}

TEST_CASE("Several recordings at once are what each would be by itself") {
  const Scratch folder;
  {
    Recorder recorder(folder.path(""));
    std::vector<std::jthread> sessions;
    for (const char name : {'a', 'b', 'c', 'd'}) {
      sessions.emplace_back([&recorder, name] {
        Environment machine = test::beamfall();
        add(*recorder.begin({MediaKind::kGif, MediaKind::kWav}, {name}, kMuch, machine), machine, 50);
      });
    }
  }
  const std::string gif = test::read(folder.path("a.gif")), wav = test::read(folder.path("a.wav"));
  CHECK(gif.size() > 10000);
  for (const std::string name : {"b", "c", "d"}) {
    CHECK((test::read(folder.path(name + ".gif")) == gif));
    CHECK((test::read(folder.path(name + ".wav")) == wav));
  }
}

TEST_CASE("A name belongs to one recording at a time") {
  const Scratch folder;
  Environment machine = test::beamfall();
  Recorder recorder(folder.path(""));
  auto first = recorder.begin({MediaKind::kY4m, MediaKind::kWav}, "a", kMuch, machine);
  CHECK_THROWS_WITH(recorder.begin({MediaKind::kGif, MediaKind::kWav}, "a", kMuch, machine),
                    Contains("a.wav is being recorded"));
  CHECK_NOTHROW(recorder.begin({MediaKind::kGif}, "a", kMuch, machine));
  first->finish();
  wait(*first);
  auto again = recorder.begin({MediaKind::kWav}, "a", kMuch, machine);
  wait(*again);
  CHECK(again->finished());
  CHECK_THAT(again->result().failure, Contains("a.wav exists"));
}

TEST_CASE("At the end all is kept, or nothing of it is there") {
  const Scratch folder;
  Environment machine = test::beamfall();
  std::size_t begins = 0;
  {
    Recorder recorder(folder.path(""));
    for (; begins < 8; ++begins)
      add(*recorder.begin({MediaKind::kPng}, std::to_string(begins), kMuch, machine), machine, 16);
    recorder.end(0ms);
    for (int i = 0; i < 1000 && !recorder.idle(); ++i) std::this_thread::sleep_for(10ms);  // a slow disk
    CHECK(recorder.idle());
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < begins; ++i) {
    if (!std::filesystem::exists(folder.path(std::to_string(i)))) continue;
    ++count;
    CHECK(test::files_in(folder.path(std::to_string(i))) == 16);
  }
  CHECK(test::files_in(folder.path("")) == count);
}

TEST_CASE("A recording that is never released does not hold up the end") {
  const Scratch folder;
  Environment machine = test::beamfall();
  std::shared_ptr<Recording> recording;
  const auto start = std::chrono::steady_clock::now();
  {
    Recorder recorder(folder.path(""));
    recording = recorder.begin({MediaKind::kGif}, "a", kMuch, machine);
    wait(*recording);  // until the file is open: one that is not is given up at once
    recorder.end(10ms);
    CHECK(!recorder.idle());
  }
  CHECK(std::chrono::steady_clock::now() - start < 20s);  // a machine may be busy; the fault would never end
  recording.reset();  // a thread that outlives the recorder removes the file, before the folder goes
  for (int i = 0; i < 2000 && test::files_in(folder.path("")) > 0; ++i) std::this_thread::sleep_for(10ms);
  CHECK(test::files_in(folder.path("")) == 0);
}
