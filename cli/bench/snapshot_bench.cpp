#include "cli/bench/snapshot_bench.hpp"

#include <array>

#include "cli/bench/cpu_clock.hpp"
#include "emulator/console.hpp"

namespace racebeam {
namespace {

constexpr int kFramesBeforeSnapshots = 120;

template <typename Action>
double nanoseconds_each(int times, Action action) {
  const double start = cpu_seconds();
  for (int i = 0; i < times; ++i) action(static_cast<std::size_t>(i));
  return (cpu_seconds() - start) / times * 1e9;
}

void time_equality(const Cartridge& cartridge, const MachineOptions& options, SnapshotTimes& times) {
  Environment one = power_on(cartridge, options), other = power_on(cartridge, options);
  other.restore(*one.save());
  std::uint64_t sum = 0;
  times.hash_ns = nanoseconds_each(1'000'000, [&](std::size_t) { sum += one.state_hash(); });
  times.compare_ns = nanoseconds_each(1'000'000, [&](std::size_t) { sum += one.same_state(other); });
  [[maybe_unused]] volatile std::uint64_t used = sum;
}

void time_client(const Cartridge& cartridge, const MachineOptions& options, SnapshotTimes& times) {
  Environment environment = power_on(cartridge, options);
  for (int frame = 0; frame < kFramesBeforeSnapshots; ++frame) environment.act(0);
  times.client_ns = time_client_snapshots(environment, 20'000);
  times.frame_ns = nanoseconds_each(1'000, [&](std::size_t) { environment.act(0); });
  times.round_ns = nanoseconds_each(1'000, [&](std::size_t) {
    const auto saved = environment.save();
    environment.act(0);
    environment.restore(*saved);
  });
}

}  // namespace

// The copies go to different places in memory, so that no value stays in registers.
double time_machine_snapshots(const Cartridge& cartridge, const MachineOptions& options, int times) {
  SystemGenerator generator{options.settings.system_seed};
  Console console{cartridge.image->bytes, cartridge.game->properties_for(cartridge.image->md5), generator};
  console.reset();
  for (int frame = 0; frame < kFramesBeforeSnapshots; ++frame) console.step();
  std::array<State, 64> saved;
  return nanoseconds_each(times, [&](std::size_t i) {
    State& place = saved[i % saved.size()];
    place = console.state();
    console.restore(place);
  });
}

double time_client_snapshots(Environment& environment, int times) {
  return nanoseconds_each(times, [&](std::size_t) { environment.restore(*environment.save()); });
}

SnapshotTimes time_snapshots(const Cartridge& cartridge, const MachineOptions& options) {
  SnapshotTimes times;
  times.machine_bytes = sizeof(State);
  times.machine_ns = time_machine_snapshots(cartridge, options, 1'000'000);
  time_equality(cartridge, options, times);
  time_client(cartridge, options, times);
  return times;
}

}  // namespace racebeam
