#include "emulator/policies/deferred_render_policy.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <vector>

using racebeam::DeferredRenderPolicy;

namespace {

// What a frame takes, in nanoseconds.
struct Frame {
  int number;
  bool observed, drawn;
  int drawn_before;  // frames in turn
};
using Cost = std::function<std::int64_t(const Frame&)>;

struct Run {
  int drawn = 0, measured = 0;  // of `deferred`, and of all
  int deferred = 0;
};

// Runs frames, of which the last `looks` of every `skip` are observed.
Run run(DeferredRenderPolicy& policy, int frames, int skip, int looks, const Cost& cost) {
  Run counts;
  int drawn_before = 0;
  for (int number = 0; number < frames; ++number) {
    const bool observed = number % skip >= skip - looks;
    const bool is_drawn = observed || policy.next_is_drawn();
    if (policy.measures()) {
      policy.record(cost({number, observed, is_drawn, drawn_before}));
      ++counts.measured;
    }
    if (!observed) ++counts.deferred, counts.drawn += is_drawn ? 1 : 0;
    drawn_before = is_drawn ? drawn_before + 1 : 0;
  }
  return counts;
}

Run run_unobserved(DeferredRenderPolicy& policy, int frames, const Cost& cost) {
  return run(policy, frames, 1, 0, cost);
}

TEST_CASE("Frames are drawn where that takes less time, however little") {
  DeferredRenderPolicy policy;
  const Run counts =
      run_unobserved(policy, 10000, [](const Frame& frame) { return frame.drawn ? 6900 : 7900; });
  CHECK(counts.drawn > 9300);
}

TEST_CASE("A fixed policy follows all frames without a measurement, whatever they would take") {
  DeferredRenderPolicy policy(true);
  const Run counts = run(policy, 100000, 2, 1, [](const Frame& frame) { return frame.drawn ? 1 : 7900; });
  CHECK(counts.drawn == 0);
  CHECK(counts.measured == 0);
}

TEST_CASE("Frames are followed where that takes less time, with few exceptions") {
  DeferredRenderPolicy policy;
  const Run counts =
      run_unobserved(policy, 10000, [](const Frame& frame) { return frame.drawn ? 7900 : 6900; });
  CHECK(counts.drawn < 100);
  CHECK(counts.measured < 200);
}

TEST_CASE("The first drawn frames, whose rows must all be drawn, do not count") {
  DeferredRenderPolicy policy;
  const Run counts = run_unobserved(policy, 10000, [](const Frame& frame) {
    if (!frame.drawn) return 7000;
    return frame.drawn_before < 2 ? 100000 : 6000;
  });
  CHECK(counts.drawn > 9300);
}

TEST_CASE("Frames that differ with their place among four are compared with their like") {
  for (const int place : {0, 1, 2, 3}) {
    const auto with = [place](int drawn) {
      return [place, drawn](const Frame& frame) {
        return (frame.number % 4 == place ? 5 : 1) * (frame.drawn ? drawn : 7000);
      };
    };
    DeferredRenderPolicy faster, slower;
    CHECK(run_unobserved(faster, 10000, with(6500)).drawn > 9300);
    CHECK(run_unobserved(slower, 10000, with(7500)).drawn < 100);
  }
}

TEST_CASE("What an observed frame saves after drawn ones counts for them") {
  for (const int skip : {2, 3, 4, 5})
    for (const int looks : {1, 2}) {
      if (looks == skip) continue;
      DeferredRenderPolicy policy;
      const Run counts = run(policy, 20000, skip, looks, [](const Frame& frame) {
        if (frame.observed) return frame.drawn_before > 0 ? 6000 : 20000;
        return frame.drawn ? 7500 : 7000;
      });
      CHECK(counts.drawn > counts.deferred * 9 / 10);
    }
}

TEST_CASE("A scene in which the other way is faster is noticed within one long period") {
  DeferredRenderPolicy policy;
  const Cost followed = [](const Frame& frame) { return frame.drawn ? 9000 : 7000; };
  const Cost drawn = [](const Frame& frame) { return frame.drawn ? 6000 : 7000; };
  run_unobserved(policy, 20000, followed);
  run_unobserved(policy, 4200, drawn);
  CHECK(run_unobserved(policy, 1000, drawn).drawn > 950);
}

TEST_CASE("A probe that another program lengthened is corrected by the next") {
  DeferredRenderPolicy policy;
  int disturbed = 0;
  run_unobserved(policy, 5000, [&](const Frame& frame) {
    if (frame.drawn) return 9000;
    return ++disturbed == 30 ? 50'000'000 : 7000;
  });
  CHECK(run_unobserved(policy, 5000, [](const Frame& frame) { return frame.drawn ? 9000 : 7000; }).drawn <
        150);
}

TEST_CASE("A machine whose frames are all observed from now on takes no measurement") {
  DeferredRenderPolicy policy;
  while (!policy.measures()) policy.next_is_drawn();
  CHECK(run(policy, 1000, 1, 1, [](const Frame&) { return 7000; }).measured == 2);
}

struct Frames {
  std::vector<int> drawn, measured;  // the first frames of each row of such frames
};

Frames frames_of(int count, std::int64_t followed, std::int64_t drawn) {
  DeferredRenderPolicy policy;
  Frames found;
  bool drew = false, measured = false;
  for (int frame = 0; frame < count; ++frame) {
    const bool draws = policy.next_is_drawn(), measures = policy.measures();
    if (measures) policy.record(draws ? drawn : followed);
    if (draws && !drew) found.drawn.push_back(frame);
    if (measures && !measured) found.measured.push_back(frame);
    drew = draws, measured = measures;
  }
  return found;
}

TEST_CASE("Probes come after 512 frames, then after twice as many, up to 4096") {
  const Frames frames = frames_of(20000, 7000, 7001);
  CHECK(frames.drawn == std::vector{479, 1503, 3551, 7647, 11743, 15839, 19935});
}

TEST_CASE("A probe draws 16 frames and follows 16, and the first four of each do not count") {
  CHECK(frames_of(600, 7000, 7001).measured == std::vector{479 + 4, 479 + 16 + 4});
  DeferredRenderPolicy policy;
  int drawn = 0, measured = 0;
  for (int frame = 0; frame < 600; ++frame) {
    drawn += policy.next_is_drawn() ? 1 : 0;
    measured += policy.measures() ? 1 : 0;
  }
  CHECK(drawn == 16);
  CHECK(measured == 24);
}

TEST_CASE("A delay moves the first probe by as many frames, up to 511") {
  for (const unsigned delay : {0U, 1U, 197U, 511U, 512U}) {
    DeferredRenderPolicy policy(false, delay);
    int frames = 0;
    while (!policy.next_is_drawn()) ++frames;
    CHECK(frames == 479 + static_cast<int>(delay % 512));
  }
}

TEST_CASE("Frames that take the same time both ways are followed") {
  CHECK(frames_of(1000, 7000, 7000).drawn == std::vector{479});
  CHECK(frames_of(1000, 7000, 6999).drawn == std::vector{479, 511});
}

}  // namespace
