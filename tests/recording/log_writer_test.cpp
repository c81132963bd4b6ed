// The logs of one session, on a simulated disk.
#include "recording/log_writer.hpp"

#include <catch2/catch.hpp>
#include <deque>
#include <functional>

#include "tests/games/scratch.hpp"
#include "tests/recording/film.hpp"
#include "tests/recording/sample_log.hpp"

using namespace racebeam;
using Catch::Matchers::Contains;

namespace {

struct Session {
  explicit Session(std::size_t most_bytes = 1 << 20) {
    SubmissionOrder order;
    order.path = folder.path("mine");
    order.unit = "beamfall-agent-2";
    order.settings = settings_without_seed(test::sample_log().settings);
    auto claim = std::make_unique<Claim>(claims, std::vector<std::string>{"mine/" + order.unit});
    writer = std::make_shared<LogWriter>(
        std::move(order), most_bytes, std::move(claim), [this](auto job) { jobs.push_back(std::move(job)); },
        given_up);
  }

  void work() {  // of the disk
    for (; !jobs.empty(); jobs.pop_front()) jobs.front()();
  }

  void add(int episode) {
    EpisodeLog log = test::sample_log();
    log.origin.episode = episode;
    writer->add(std::move(log), nullptr);
  }

  bool has_log(int episode) const {
    return std::filesystem::exists(
        folder.path("mine/logs/beamfall-agent-2/" + std::to_string(episode) + ".episode"));
  }

  Scratch folder;
  std::deque<std::function<void()>> jobs;
  std::shared_ptr<Claims> claims = std::make_shared<Claims>();
  std::shared_ptr<std::atomic<bool>> given_up = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<LogWriter> writer;
};

}  // namespace

TEST_CASE("Each call to a writer of logs is behind until the disk has done its work") {
  Session session;
  CHECK(session.writer->name() == "mine");
  CHECK_FALSE(session.writer->is_behind());
  session.writer->begin();
  CHECK(session.writer->is_behind());
  CHECK_FALSE(std::filesystem::exists(session.folder.path("mine")));
  session.work();
  CHECK_FALSE(session.writer->is_behind());
  const std::size_t before = session.writer->result().bytes;
  CHECK(before > 0);
  session.add(1);
  CHECK(session.writer->is_behind());
  session.work();
  CHECK(session.writer->result().logged == 1);
  CHECK(session.writer->result().bytes > before + test::read(session.folder.path("mine/agent.toml")).size());
  CHECK(session.has_log(1));
  CHECK_FALSE(session.writer->finished());
  session.writer->finish();
  CHECK(session.writer->is_behind());
  CHECK_FALSE(session.claims->empty());
  session.work();
  CHECK(session.writer->finished());
  CHECK_FALSE(session.writer->is_behind());
  CHECK(session.claims->empty());
  CHECK_FALSE(session.writer->cut());
  CHECK(session.writer->result().failure.empty());
  session.writer->finish();
  CHECK(session.jobs.empty());
}

TEST_CASE("The charge of a log is released when the disk has it") {
  Session session;
  session.writer->begin();
  auto charge = std::make_shared<const int>();
  const std::weak_ptr<const int> charged = charge;
  session.writer->add(test::sample_log(), std::move(charge));
  CHECK_FALSE(charged.expired());
  session.work();
  CHECK(charged.expired());
}

TEST_CASE("After the log that exceeds the limit, a writer writes no more logs") {
  Session session(2 * 4096 + 1500);
  session.writer->begin();
  for (int episode = 1; episode <= 3; ++episode) session.add(episode);
  session.work();
  CHECK(session.writer->cut() == Recording::Cut::kLimit);
  CHECK_THAT(session.writer->result().failure, Contains("limit of 9692 bytes"));
  const int logged = session.writer->result().logged;
  CHECK((logged >= 1 && logged < 3));
  for (int episode = 1; episode <= 3; ++episode) CHECK(session.has_log(episode) == (episode <= logged));
  CHECK_FALSE(session.writer->finished());
  session.writer->finish();
  session.work();
  CHECK(session.writer->finished());
}

TEST_CASE("After a log that the disk refuses, a writer writes no more logs") {
  Session session;
  session.writer->begin();
  session.add(1);
  session.work();
  std::filesystem::rename(session.folder.path("mine/results.csv"), session.folder.path("table"));
  std::filesystem::create_directory(session.folder.path("mine/results.csv"));
  session.add(2);
  session.work();
  CHECK(session.writer->cut() == Recording::Cut::kDisk);
  CHECK_THAT(session.writer->result().failure, Contains("cannot open results.csv"));
  std::filesystem::remove(session.folder.path("mine/results.csv"));
  session.add(3);
  session.work();
  CHECK(session.writer->result().logged == 1);
  CHECK((session.has_log(1) && !session.has_log(2) && !session.has_log(3)));
}

TEST_CASE("A writer that cannot begin gives the reason, and has finished") {
  Session session;
  session.folder.write("mine", "a file");
  session.writer->begin();
  session.work();
  CHECK(session.writer->finished());
  CHECK(session.claims->empty());
  CHECK_THAT(session.writer->result().failure, Contains("mine exists"));
  session.add(1);
  session.work();
  CHECK(session.writer->result().logged == 0);
}

TEST_CASE("A writer that is given up begins nothing, and writes nothing more") {
  Session early, late;
  *early.given_up = true;
  early.writer->begin();
  early.work();
  CHECK(early.writer->finished());
  CHECK(early.writer->result().failure == "the server stops");
  CHECK(test::files_in(early.folder.path("")) == 0);
  late.writer->begin();
  late.work();
  *late.given_up = true;
  late.add(1);
  late.work();
  CHECK(late.writer->result().logged == 0);
  CHECK_FALSE(late.has_log(1));
}
