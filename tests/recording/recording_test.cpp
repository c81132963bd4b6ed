// One recording, on a simulated disk.
#include "recording/recording.hpp"

#include <catch2/catch.hpp>
#include <deque>
#include <functional>

#include "tests/games/scratch.hpp"
#include "tests/recording/film.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;

namespace {

struct Film {
  explicit Film(std::vector<MediaKind> kinds, std::size_t most_bytes = 1 << 30, std::string name = "a") {
    Order order{std::move(kinds),
                folder.path(""),
                std::move(name),
                most_bytes,
                {static_cast<std::size_t>(machine.height()), palette(machine.format()), 60}};
    order.charge = charge;
    memory = order.memory();
    auto claim = std::make_unique<Claim>(claims, order.file_names());
    recording = std::make_shared<Recording>(
        std::move(order), std::move(claim), [this](auto job) { jobs.push_back(std::move(job)); }, given_up);
    recording->begin();
  }

  void work(std::size_t most = 1 << 20) {  // of the disk
    for (; most > 0 && !jobs.empty(); --most) {
      jobs.front()();
      jobs.pop_front();
    }
  }

  int add_until_behind(int most = 10000) {
    int added = 0;
    for (; !recording->is_behind() && added < most; ++added) {
      machine.act(0);
      recording->add(machine);
    }
    return added;
  }

  Scratch folder;
  std::deque<std::function<void()>> jobs;
  std::shared_ptr<Claims> claims = std::make_shared<Claims>();
  std::shared_ptr<std::atomic<bool>> given_up = std::make_shared<std::atomic<bool>>(false);
  Environment machine = test::beamfall();
  std::shared_ptr<const int> charge = std::make_shared<const int>();
  std::size_t memory = 0;
  std::shared_ptr<Recording> recording;
};

}  // namespace

TEST_CASE("A recording is behind until the disk has begun it") {
  Film film({MediaKind::kGif});
  CHECK(film.recording->is_behind());
  CHECK(test::files_in(film.folder.path("")) == 0);
  film.work();
  CHECK(!film.recording->is_behind());
  CHECK(!film.recording->finished());
}

TEST_CASE("Frames that the disk has not taken are few") {
  Film film({MediaKind::kY4m, MediaKind::kWav});
  film.work();
  const int waiting = film.add_until_behind();
  CHECK(waiting == 16);
  CHECK(film.memory > std::size_t{16} * 160 * 210);
  CHECK(film.memory < std::size_t{4} << 20);
  film.work(1);
  CHECK(film.add_until_behind() == 1);
  film.recording->finish();
  CHECK(film.recording->is_behind());
  film.work();
  CHECK(film.recording->finished());
  CHECK(film.recording->result().frames == 17);
  CHECK(film.recording->result().names == "a.y4m,a.wav");
}

TEST_CASE("A recording of only sound needs no room for pictures") {
  Film film({MediaKind::kWav});
  film.work();
  CHECK(film.add_until_behind() == 1024);
  CHECK(film.memory < std::size_t{1} << 20);
}

TEST_CASE("A frame is recorded as it was when it was added") {
  Film late({MediaKind::kY4m}), early({MediaKind::kY4m});
  late.work();
  early.work();
  for (int frame = 0; frame < 10; ++frame) {
    late.add_until_behind(1);
    early.add_until_behind(1);
    early.work();
  }
  for (Film* film : {&late, &early}) {
    film->recording->finish();
    film->work();
  }
  const std::string file = test::read(early.folder.path("a.y4m"));
  CHECK(file.size() > 10 * 3 * 320 * 210);
  CHECK((file == test::read(late.folder.path("a.y4m"))));
}

TEST_CASE("A recording that is cut off is kept at once, and holds up nothing") {
  Film film({MediaKind::kY4m}, 1'000'000);
  film.work();
  CHECK(film.add_until_behind() == 16);
  CHECK(!film.recording->cut());
  film.work();
  CHECK(film.recording->cut() == Recording::Cut::kLimit);
  CHECK(film.recording->finished());
  CHECK(film.recording->result().frames == 4);
  CHECK(film.recording->result().bytes == test::read(film.folder.path("a.y4m")).size());
  CHECK(film.add_until_behind(100) == 100);
  film.recording->finish();
  CHECK(film.jobs.empty());
  CHECK(film.claims->empty());
}

TEST_CASE("A recording is charged for the queue, each encoder, and each process of an encoder") {
  const Environment machine = test::beamfall();
  const auto memory = [&](std::vector<MediaKind> kinds) {
    return Order{std::move(kinds), "", "a", 1, {210, palette(machine.format()), 60}}.memory();
  };
  const std::size_t gif = memory({MediaKind::kGif}), both = memory({MediaKind::kGif, MediaKind::kY4m});
  CHECK(both - gif == 12 * 160 * 210 + (std::size_t{1} << 19));
  CHECK(memory({MediaKind::kMp4}) - gif == std::size_t{80} << 20);
  CHECK(memory({MediaKind::kMp4, MediaKind::kWebm}) - both == std::size_t{160} << 20);
}

TEST_CASE("A recording that is given up before it begins leaves nothing") {
  Film film({MediaKind::kGif});
  *film.given_up = true;
  film.work();
  CHECK(film.recording->finished());
  CHECK(film.recording->result().failure == "the server stops");
  CHECK(test::files_in(film.folder.path("")) == 0);
}

TEST_CASE("The reason of a cut has the name that clients know") {
  CHECK(name_of(Recording::Cut::kLimit) == "limit");
  CHECK(name_of(Recording::Cut::kDisk) == "disk");
  CHECK(name_of(Recording::Cut::kEncoder) == "encoder");
}

TEST_CASE("If one of two files cannot be committed, the other still is") {
  Film film({MediaKind::kY4m, MediaKind::kWav});
  film.work();
  film.folder.write("a.y4m", "another file");
  film.add_until_behind(5);
  film.recording->finish();
  film.work();
  CHECK(film.recording->cut() == Recording::Cut::kDisk);
  CHECK(film.recording->result().names == "a.wav");
  CHECK_THAT(film.recording->result().failure, Contains("cannot create a.y4m"));
  CHECK(test::read(film.folder.path("a.y4m")) == "another file");
  CHECK(test::files_in(film.folder.path("")) == 2);
}

TEST_CASE("A recording that cannot begin gives the reason, and leaves nothing") {
  Film film({MediaKind::kWav, MediaKind::kGif}, 100);
  film.work();
  CHECK(!film.recording->is_behind());
  CHECK(film.recording->finished());
  CHECK_THAT(film.recording->result().failure, Contains("limit of 100 bytes"));
  CHECK(test::files_in(film.folder.path("")) == 0);
  CHECK(film.claims->empty());
}

TEST_CASE("A recording is charged for until all of it is written") {
  Film film({MediaKind::kGif});
  const std::weak_ptr<const int> charge = film.charge;
  film.charge.reset();
  film.work();
  film.add_until_behind();
  film.recording->finish();
  film.recording.reset();
  film.work(16);
  CHECK(!charge.expired());
  film.work();
  CHECK(charge.expired());
}

TEST_CASE("An aborted recording leaves nothing") {
  Film film({MediaKind::kPng, MediaKind::kGif});
  film.work();
  film.add_until_behind(10);
  film.recording->finish();
  film.work(5);
  *film.given_up = true;
  film.work();
  CHECK(film.recording->finished());
  CHECK(film.recording->result().names.empty());
  CHECK(test::files_in(film.folder.path("")) == 0);
}
