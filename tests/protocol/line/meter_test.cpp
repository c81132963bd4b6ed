#include "protocol/line/meter.hpp"

#include <catch2/catch.hpp>

#include "protocol/line/commands/command_table.hpp"
#include "tests/protocol/line_client.hpp"

using namespace racebeam;
using namespace std::chrono_literals;

TEST_CASE("A latency is counted under the first bound that it does not exceed") {
  Meter meter(commands().size());
  meter.request(0, false, 0ns);
  meter.request(0, false, 10us);
  meter.request(0, true, 10'001ns);
  meter.request(0, false, 1h);
  CHECK(meter.latencies[0].value() == 2);
  CHECK(meter.latencies[1].value() == 1);
  CHECK(meter.latencies.back().value() == 1);
  CHECK(meter.requests[0].done.value() == 3);
  CHECK(meter.requests[0].refused.value() == 1);
  CHECK(meter.nanoseconds.value() == std::chrono::nanoseconds(1h + 20'001ns).count());
}

TEST_CASE("A session counts its requests and frames into its meter") {
  const LineService service = test::line_service();
  Meter meter(commands().size());
  LineSession session(service, &meter);
  const std::string requests = "load beamfall sticky=0\nact NOOP*300\nact 99\nnonsense\n\n";
  std::ranges::copy(requests, session.space().begin());
  session.received(requests.size());
  while (session.run()) session.sent(session.output().size());
  const auto row = static_cast<std::size_t>(&find_command("act") - commands().data());
  CHECK(meter.frames.value() == 300);
  CHECK(meter.requests[row].done.value() == 1);
  CHECK(meter.requests[row].refused.value() == 1);
  CHECK(meter.requests.back().refused.value() == 2);
  std::int64_t all = 0;
  for (const Counter& latency : meter.latencies) all += latency.value();
  CHECK(all == 5);
}
