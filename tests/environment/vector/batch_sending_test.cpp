// Machines of a batch that are sent and received, in any order and in parts.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/environment/vector/batches.hpp"

namespace racebeam {
namespace {

using test::copies, test::part, test::short_episodes;

TEST_CASE("Machines that are sent and received in any order play as they do together") {
  for (const Autoreset autoreset : {Autoreset::kNextStep, Autoreset::kSameStep}) {
    auto settings = short_episodes();
    settings.autoreset = autoreset;
    Batch together(copies(5), settings);
    std::vector<BatchResults> expected;  // after each step
    for (int step = 0; step < 12; ++step) {
      expected.push_back(together.make_results());
      together.step(std::vector{1, 2, 3, 4, 5}, expected.back().arrays());
    }
    settings.batch_size = 2;
    settings.threads = 3;
    Batch apart(copies(5), settings);
    CHECK(apart.batch_size() == 2);
    const std::vector<std::int32_t> all{0, 1, 2, 3, 4};
    apart.send(std::vector{1, 2, 3, 4, 5}, all);
    std::vector<std::size_t> steps(5);
    BatchResults results = apart.make_results();
    while (std::ranges::any_of(steps, [](std::size_t count) { return count < 12; })) {
      apart.receive(results.arrays());
      std::vector<int> actions;
      for (std::size_t position = 0; position < 2; ++position) {
        const auto machine = static_cast<std::size_t>(results.numbers[position]);
        actions.push_back(static_cast<int>(machine) + 1);
        if (steps[machine] >= expected.size()) continue;
        const BatchResults& should = expected[steps[machine]++];
        CHECK(part(results.observations, position, 2) == part(should.observations, machine, 5));
        CHECK(results.episode_frames[position] == should.episode_frames[machine]);
        CHECK(results.finished[position] == should.finished[machine]);
        if (autoreset == Autoreset::kSameStep && should.finished[machine] != 0) {
          CHECK(part(results.final_observations, position, 2) == part(should.final_observations, machine, 5));
          CHECK(part(results.final_ram, position, 2) == part(should.final_ram, machine, 5));
          CHECK(results.final_episode_frames[position] == should.final_episode_frames[machine]);
          CHECK(results.final_frames[position] == should.final_frames[machine]);
          CHECK(should.final_episode_frames[machine] >= 30);
        }
      }
      apart.send(actions, results.numbers);
    }
  }
}

TEST_CASE("A batch that sends says what can't be sent or received") {
  auto settings = short_episodes();
  settings.batch_size = 2;
  Batch batch(copies(3), settings);
  BatchResults results = batch.make_results();
  CHECK_THROWS_WITH(batch.receive(results.arrays()),
                    "0 machines play, and a receive takes 2; send some first");
  CHECK_THROWS_WITH(batch.send(std::vector{0}, std::vector{3}),
                    "machine 3 is out of range; accepted: 0 to 2");
  CHECK_THROWS_WITH(batch.send(std::vector{0, 0}, std::vector{1, 1}),
                    "machine 1 plays already; receive it first");
  CHECK_THROWS_WITH(batch.send(std::vector{0}, std::vector{1, 2}), "there are 1 actions for 2 machines");
  batch.send_resets();
  CHECK_THROWS_WITH(batch.step(std::vector{0, 0, 0}, results.arrays()),
                    "3 machines play; receive them first");
  batch.receive(results.arrays());
  CHECK_THROWS_WITH(batch.receive(results.arrays()),
                    "1 machines play, and a receive takes 2; send some first");
  const int playing = 3 - results.numbers[0] - results.numbers[1];
  CHECK_THROWS_WITH(batch.slot(std::size_t(playing)),
                    "machine " + std::to_string(playing) + " plays; receive it first");
  batch.send(std::vector{0}, std::span(results.numbers).first(1));
  batch.receive(results.arrays());
}

TEST_CASE("All machines of a batch are received as they were sent, whichever finished first") {
  auto settings = short_episodes();
  settings.threads = 2;
  Batch halves(copies(5), settings), whole(copies(5), settings);
  BatchResults results = halves.make_results(), expected = whole.make_results();
  for (int step = 0; step < 20; ++step) {
    halves.send(std::vector{4, 3, 2, 1, 0}, std::vector{4, 2, 3, 0, 1});
    halves.receive(results.arrays());
    whole.step(std::vector{1, 0, 3, 2, 4}, expected.arrays());
    CHECK(results.numbers == std::vector{4, 2, 3, 0, 1});
    halves.show(results.arrays());
    CHECK(results.observations == expected.observations);
    CHECK(results.episode_frames == expected.episode_frames);
  }
}

TEST_CASE("A batch may be sent and received in parts") {
  const auto settings = short_episodes();
  Batch parts(copies(4), settings), whole(copies(4), settings);
  BatchResults results = parts.make_results(), expected = whole.make_results();
  parts.send(std::vector{1, 2}, std::vector{3, 1});
  CHECK(parts.playing() == 2);
  CHECK_THROWS_WITH(parts.receive(results.arrays(), 3),
                    "2 machines play, and a receive takes 3; send some first");
  parts.receive(results.arrays(), 2);
  CHECK(std::vector(results.numbers.begin(), results.numbers.begin() + 2) == std::vector{3, 1});
  parts.receive(results.arrays(), 0);
  parts.end_episodes(std::vector{2}, std::vector<std::int64_t>{9});
  parts.send(std::vector{3, 3}, std::vector{0, 2});
  CHECK_THROWS_WITH(parts.end_episodes(std::vector{1, 0}), "machine 0 plays already; receive it first");
  parts.receive(results.arrays(), parts.playing());
  CHECK(parts.playing() == 0);
  whole.step(std::vector{3, 2, 0, 1}, expected.arrays());
  whole.reset(expected.arrays(), std::vector<std::uint8_t>{0, 0, 1, 0},
              std::vector<std::int64_t>{-1, -1, 9, -1});
  parts.show(results.arrays());
  CHECK(results.observations == expected.observations);
  CHECK(results.frames == expected.frames);
}

}  // namespace
}  // namespace racebeam
