#include "agents/learning/ram_sarsa.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "agents/features/ram_bits.hpp"
#include "agents/learning/sarsa.hpp"

using namespace racebeam;

namespace {

using Ram = std::array<std::uint8_t, kRamSize>;

SarsaSettings exploring() {
  SarsaSettings settings;
  settings.step_size = 0.2;
  settings.trace_decay = 0.5;
  settings.exploration = 1;  // both learners draw the same actions, whatever their values are
  return settings;
}

// Bits that never change, that rarely change, and that often do.
Ram first_memory(Random& random) {
  Ram ram;
  for (std::uint8_t& byte : ram) byte = static_cast<std::uint8_t>(random.below(256));
  return ram;
}

void change(Ram& ram, Random& random) {
  for (int i = 0; i < 3; ++i) ram[random.below(8)] = static_cast<std::uint8_t>(random.below(256));
  ++ram[8];
  if (random.below(5) == 0) ram[9 + random.below(60)] ^= static_cast<std::uint8_t>(1U << random.below(8));
}

ActiveFeatures features_of(const Ram& ram) {
  ActiveFeatures features;
  RamBits().extract(ram, features);
  return features;
}

std::size_t feature_of_pair(std::size_t bit, std::size_t other) {
  if (bit == other) return bit;
  return PairWeights::kBits + pair_index(static_cast<std::uint32_t>(std::min(bit, other)),
                                         static_cast<std::uint32_t>(std::max(bit, other)));
}

// The largest difference between weights, and the largest weight.
std::pair<double, double> difference(const RamSarsa& fast, const Sarsa& plain) {
  double most = 0, largest = 0;
  for (std::size_t bit = 0; bit < PairWeights::kBits; ++bit) {
    for (std::size_t other = 0; other <= bit; ++other) {
      for (int action = 0; action < kActions; ++action) {
        const double weight = plain.weight(feature_of_pair(bit, other), action);
        most = std::max(most, std::abs(weight - fast.weights().weight(bit, other, action)));
        largest = std::max(largest, std::abs(weight));
      }
    }
  }
  return {most, largest};
}

void compare(const SarsaSettings& settings, int episodes, int decisions) {
  RamSarsa fast(settings, 1);
  Sarsa plain(settings, RamBits().size(), 1);
  Random random(2);
  for (int episode = 0; episode < episodes; ++episode) {
    Ram ram = first_memory(random);
    REQUIRE(fast.begin(ram) == plain.begin(features_of(ram)));
    for (int decision = 0; decision < decisions; ++decision) {
      change(ram, random);
      const double reward = random.below(4) == 0 ? static_cast<double>(random.below(9)) - 3 : 0;
      REQUIRE(fast.next(reward, ram) == plain.next(reward, features_of(ram)));
    }
    const ActiveFeatures features = features_of(ram);
    CHECK(fast.weights().active() == features.indices.size());
    for (int action = 0; action < kActions; ++action)
      CHECK(fast.weights().values()[static_cast<std::size_t>(action)] ==
            Approx(plain.value(features, action)).epsilon(1e-4).margin(1e-4));
    const auto [before_end, size] = difference(fast, plain);
    CHECK(before_end < 1e-4 * size);
    fast.end(5);
    plain.end(5);
    const auto [after_end, largest] = difference(fast, plain);
    CHECK(largest > 0);
    CHECK(after_end < 1e-4 * largest);
  }
}

}  // namespace

TEST_CASE("RAM's learner learns the weights that SARSA learns on all pairs of bits") {
  SECTION("with traces of the paper's length") { compare(exploring(), 2, 150); }
  SECTION("without traces") {
    SarsaSettings settings = exploring();
    settings.trace_decay = 0;
    compare(settings, 1, 100);
  }
  SECTION("with long traces") {
    SarsaSettings settings = exploring();
    settings.trace_decay = 0.9;
    compare(settings, 2, 120);
  }
  SECTION("where an action clears the traces of others") {
    SarsaSettings settings = exploring();
    settings.clear_other_traces = true;
    compare(settings, 2, 120);
  }
}

TEST_CASE("RAM's learner chooses what it has learned is best") {
  SarsaSettings settings = exploring();
  settings.exploration = 0.1;
  RamSarsa fast(settings, 1);
  Ram ram{};
  ram[3] = 0x81;
  for (int episode = 0; episode < 300; ++episode) {
    const int action = fast.begin(ram);
    fast.end(action == 7 ? 1 : -1);
  }
  fast.set_learning(false);
  int best = 0;
  for (int episode = 0; episode < 100; ++episode) best += fast.begin(ram) == 7;
  CHECK(best > 85);
}

TEST_CASE("RAM's learner learns nothing in evaluation") {
  RamSarsa fast(exploring(), 1);
  fast.set_learning(false);
  Ram ram{};
  ram[0] = 1;
  fast.begin(ram);
  ram[0] = 2;
  fast.next(5, ram);
  fast.end(5);
  for (int action = 0; action < kActions; ++action) CHECK(fast.weights().weight(0, 0, action) == 0);
}

TEST_CASE("RAM's learner that was written goes on as the one that wrote it") {
  RamSarsa one(exploring(), 1), other(exploring(), 2);
  const auto play = [](RamSarsa& sarsa, std::uint64_t seed) {
    Random random(seed);
    Ram ram = first_memory(random);
    std::vector<double> seen{double(sarsa.begin(ram))};
    for (int i = 0; i < 100; ++i) {
      change(ram, random);
      seen.push_back(sarsa.next(static_cast<double>(random.below(3)), ram));
      seen.push_back(sarsa.weights().values()[3]);
    }
    sarsa.end(1);
    return seen;
  };
  play(one, 5);
  StateWriter out;
  one.write(out);
  StateReader in(out.bytes());
  other.read(in);
  CHECK(in.at_end());
  CHECK(play(one, 6) == play(other, 6));
}

TEST_CASE("Traces that are too long for RAM's learner are known before, and refused") {
  SarsaSettings settings;
  settings.trace_decay = 0.5;
  CHECK(PairWeights::decisions_of_trace(settings) == 7);
  settings.trace_decay = 0;
  CHECK(PairWeights::decisions_of_trace(settings) == 1);
  settings.trace_decay = 0.9;
  CHECK(PairWeights::decisions_of_trace(settings) == 44);
  settings.least_trace = 0;
  CHECK(PairWeights::decisions_of_trace(settings) == 0);
  CHECK_THROWS_WITH(RamSarsa(settings, 1), "traces last for more than 64 decisions");
}

TEST_CASE("RAM's learner notices weights that are not finite") {
  SarsaSettings settings = exploring();
  settings.step_size = 100;
  settings.discount = 0.5;
  settings.reward_scale = RewardScale::kNone;
  RamSarsa fast(settings, 1, 1);
  Ram ram{};
  ram[0] = 1;
  fast.begin(ram);
  for (int i = 0; i < 300 && !fast.diverged(); ++i) fast.next(1e6, ram);
  CHECK(fast.diverged());
}
