// What a session counts: for its client, as `stats`, and for the server's metrics.
#include <catch2/catch.hpp>
#include <string>

#include "protocol/line/commands/command_table.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using namespace std::chrono_literals;
using test::kLoad;
using test::LineClient;
using test::value;

TEST_CASE("stats has the requests and errors before it, and itself as a request") {
  LineClient client;
  CHECK(client.ask("stats") ==
        "ok requests=1 errors=0 acts=0 frames=0 episodes=0 bytes_in=6 bytes_out=0 states=0 machines=0");
  client.say("nonsense\n\nhelp act\nact NOOP\n");
  const std::string stats = client.ask("stats");
  CHECK(value(stats, "requests") == "6");
  CHECK(value(stats, "errors") == "3");
}

TEST_CASE("stats has the bytes of each line with its end, of comments, too, and of each reply") {
  LineClient client;
  const std::string requests = "# a comment\n  # another\nhelp act\nnonsense\n";
  const std::string replies = client.say(requests);
  const std::string stats = client.ask("stats");
  CHECK(value(stats, "requests") == "3");
  CHECK(value(stats, "bytes_in") == std::to_string(requests.size() + 6));
  CHECK(value(stats, "bytes_out") == std::to_string(replies.size()));
  CHECK(value(client.ask("stats"), "bytes_out") == std::to_string(replies.size() + stats.size() + 1));
}

TEST_CASE("stats has the acts, frames and episodes of the session, and what it keeps") {
  LineClient client;
  client.say("load beamfall seed=7 sticky=0 frame_skip=3 max_episode_frames=9\nact NOOP\nsave a\n");
  const auto counts = [&] {
    const std::string stats = client.ask("stats");
    return value(stats, "acts") + " " + value(stats, "frames") + " " + value(stats, "episodes");
  };
  CHECK(counts() == "1 3 0");
  client.ask("act NOOP*2");
  CHECK(counts() == "3 9 1");
  client.ask("act NOOP");  // the episode is over
  CHECK(counts() == "3 9 1");
  client.say("open 2 autoreset=disabled\nstep NOOP\n");
  CHECK(counts() == "5 15 1");
  const std::string stats = client.ask("stats");
  CHECK(value(stats, "states") == "1");
  CHECK(value(stats, "machines") == "2");
}

TEST_CASE("A meter has the time from the first to the last slice of a request") {
  const LineService service = test::line_service();
  Meter meter(commands().size());
  LineSession session(service, &meter);
  const std::string requests = kLoad + " max_episode_frames=0\nact NOOP*2000\n";
  std::ranges::copy(requests, session.space().begin());
  session.received(requests.size());
  std::chrono::nanoseconds worked = 0ns;
  for (bool more = true; more; session.sent(session.output().size())) {
    more = session.run(0us);
    worked += session.worked();
  }
  CHECK(meter.nanoseconds.value() > worked.count() / 2);
  CHECK(worked > 0ns);
}
