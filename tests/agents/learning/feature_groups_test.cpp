#include "agents/learning/feature_groups.hpp"

#include <catch2/catch.hpp>

#include "agents/learning/sarsa.hpp"
#include "system/invalid_input.hpp"

using namespace racebeam;

namespace {

using Indices = std::vector<std::uint32_t>;
using Counts = std::vector<float>;
using Splits = std::vector<FeatureSplit>;

struct Grouped {
  Indices groups;
  Counts sizes;
  Splits splits;
};

Grouped group(FeatureGroups& groups, Indices features) {
  ActiveFeatures active{std::move(features), {}};
  const auto splits = groups.replace(active);
  return {active.indices, active.counts, {splits.begin(), splits.end()}};
}

// Clusters of 1 to 8 of the 40 features are active together; some part after a while.
Indices draw_state(Random& random, int step) {
  Indices state;
  for (std::uint32_t cluster = 0; cluster < 8; ++cluster) {
    if (random.below(3) == 0) continue;
    for (std::uint32_t feature = 0; feature <= cluster; ++feature)
      if (step < 100 || random.below(4) != 0) state.push_back(cluster * (cluster + 1) / 2 + feature);
  }
  return state;
}

}  // namespace

TEST_CASE("Features that were always active together are one group, and are split when they part") {
  FeatureGroups groups(100);
  Grouped now = group(groups, {10, 20, 30});  // group 0
  CHECK((now.groups == Indices{0} && now.sizes == Counts{3} && now.splits.empty()));
  now = group(groups, {10, 20, 30, 114702399});  // a new one: group 1
  CHECK((now.groups == Indices{0, 1} && now.sizes == Counts{3, 1} && now.splits.empty()));
  now = group(groups, {20, 30});  // 10 stays group 0
  CHECK((now.groups == Indices{2} && now.sizes == Counts{2} && now.splits == Splits{{0, 2, 2}}));
  now = group(groups, {10, 30, 40});  // 40 is group 3, 30 leaves group 2
  CHECK((now.groups == Indices{0, 3, 4} && now.sizes == Counts{1, 1, 1} && now.splits == Splits{{2, 4, 1}}));
  now = group(groups, {});
  CHECK((now.groups.empty() && now.splits.empty()));
  CHECK(groups.count() == 5);
  CHECK(groups.seen() == 5);
}

TEST_CASE("Features beyond the most that may be seen are left out") {
  FeatureGroups groups(3);
  CHECK(group(groups, {1, 2}).sizes == Counts{2});
  CHECK(group(groups, {1, 2, 3, 4}).sizes == Counts{2, 1});
  CHECK(group(groups, {4}).groups.empty());
  CHECK(group(groups, {3}).sizes == Counts{1});
  CHECK(groups.seen() == 3);
}

TEST_CASE("Only features that were seen take memory, so much for each at most") {
  FeatureGroups groups(50000);
  CHECK(groups.bytes() == FeatureGroups::kMinBytes);
  Random random(3);
  for (int state = 0; state < 2000; ++state) {
    Indices features;
    for (int i = 0; i < 100; ++i) features.push_back(static_cast<std::uint32_t>(random.below(114702400)));
    std::ranges::sort(features);
    features.erase(std::unique(features.begin(), features.end()), features.end());
    group(groups, features);
    REQUIRE(groups.bytes() <= FeatureGroups::kMinBytes +
                                  (groups.seen() + 100) * FeatureGroups::kMaxSlotBytes +
                                  groups.count() * FeatureGroups::kGroupBytes);
  }
  CHECK(groups.seen() == 50000);
  CHECK(groups.bytes() <= 50000 * (FeatureGroups::kMaxSlotBytes + FeatureGroups::kGroupBytes));
}

TEST_CASE("A learner on groups has the weights of one on the features themselves") {
  for (const bool clear : {true, false}) {
    const SarsaSettings settings{.clear_other_traces = clear};
    Sarsa single(settings, 40, 1), shared(settings, 0, 1);
    FeatureGroups groups(40);
    Random random(5);
    std::size_t splits = 0;
    const auto grouped = [&](const Indices& state) {
      ActiveFeatures active{state, {}};
      const auto parts = groups.replace(active);
      splits += parts.size();
      shared.refine(groups.count(), parts);
      return active;
    };
    for (int episode = 0; episode < 10; ++episode) {
      Indices state = draw_state(random, 0);
      REQUIRE(single.begin({state, {}}) == shared.begin(grouped(state)));
      for (int step = 0; step < 300; ++step) {
        state = draw_state(random, step);
        const ActiveFeatures active = grouped(state);
        for (int action = 0; action < kActions; ++action)
          REQUIRE(single.value({state, {}}, action) == Approx(shared.value(active, action)).margin(1e-6));
        const auto reward = static_cast<double>(random.below(3));
        REQUIRE(single.next(reward, {state, {}}) == shared.next(reward, active));
      }
      single.end(1);
      shared.end(1);
    }
    CHECK(splits > 20);
    CHECK(groups.count() <= 40);
  }
}

TEST_CASE("Groups and their learner that were written go on as those that wrote them") {
  FeatureGroups groups(100), others(100);
  Sarsa sarsa({}, 0, 1), other({}, 0, 2);
  const auto step = [](FeatureGroups& of, Sarsa& learner, const Indices& state) {
    ActiveFeatures active{state, {}};
    const auto splits = of.replace(active);
    learner.refine(of.count(), splits);
    return active;
  };
  sarsa.begin(step(groups, sarsa, {1, 2, 3}));
  sarsa.next(1, step(groups, sarsa, {1, 4}));
  sarsa.end(2);
  StateWriter out;
  sarsa.write(out);
  groups.write(out);
  StateReader in(out.bytes());
  other.read(in);
  others.read(in);
  CHECK(in.at_end());
  CHECK(others.bytes() == groups.bytes());
  for (const Indices& state : {Indices{2, 4}, Indices{3}, Indices{1, 5}}) {
    const auto one = step(groups, sarsa, state), two = step(others, other, state);
    CHECK(one.indices == two.indices);
    CHECK(one.counts == two.counts);
    CHECK(sarsa.begin(one) == other.begin(two));
    for (int action = 0; action < kActions; ++action)
      CHECK(sarsa.value(one, action) == other.value(two, action));
  }
}

TEST_CASE("Groups of a checkpoint that lead beyond their tables are refused") {
  FeatureGroups groups(100);
  group(groups, {1, 2, 3});
  group(groups, {1, 4});
  StateWriter out;
  groups.write(out);
  const std::string written = out.bytes();
  const auto is_refused = [](const std::string& bytes) {
    StateReader in(bytes);
    FeatureGroups others(100);
    try {
      others.read(in);
    } catch (const InvalidInput&) {
      return true;
    }
    return false;
  };
  CHECK(!is_refused(written));
  for (std::size_t byte = 0; byte < written.size(); ++byte) {
    std::string altered = written;
    altered[byte] = static_cast<char>(altered[byte] ^ 0x40);
    INFO(byte);
    CHECK(is_refused(altered));
  }
}
