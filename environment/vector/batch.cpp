#include "environment/vector/batch.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "environment/vector/lane.hpp"
#include "environment/vector/thread_pool.hpp"

namespace racebeam {
namespace {

void refuse_unless(bool good, const std::string& sentence) {
  if (!good) throw std::invalid_argument(sentence);
}

const BatchSettings& checked(const BatchSettings& settings) {
  refuse_unless(settings.frame_skip >= 1, "a step has " + std::to_string(settings.frame_skip) +
                                              " frames; it must have 1 or more");
  refuse_unless(settings.stack >= 0, "the stack has " + std::to_string(settings.stack) +
                                         " screens; it must have 0 or more");
  refuse_unless(!settings.machine.color_averaging, "a batch has no colour averaging; it takes max_pool");
  return settings;
}

}  // namespace

struct Batch::Impl {
  Impl(std::span<const Cartridge> cartridges, const BatchSettings& given);

  void open(std::span<const Cartridge> cartridges);
  void make_room();
  void reset(std::size_t machine) { lanes[machine]->reset(results); }
  void check(std::span<const int> actions) const;

  const BatchSettings settings;
  ThreadPool threads;
  std::vector<std::unique_ptr<Lane>> lanes;
  BatchResults results;
  int height = 0;
};

Batch::Impl::Impl(std::span<const Cartridge> cartridges, const BatchSettings& given)
    : settings(checked(given)), threads(settings.threads) {
  open(cartridges);
  make_room();
  threads.run(lanes.size(), [this](std::size_t machine) { reset(machine); });
}

// The first error of any machine is everybody's.
void Batch::Impl::open(std::span<const Cartridge> cartridges) {
  lanes.resize(cartridges.size());
  std::vector<std::exception_ptr> errors(cartridges.size());
  threads.run(lanes.size(), [&](std::size_t machine) {
    try {
      lanes[machine] = std::make_unique<Lane>(cartridges[machine], settings, machine);
    } catch (...) {
      errors[machine] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  for (const auto& lane : lanes) height = std::max(height, lane->environment().height());
}

void Batch::Impl::make_room() {
  const std::size_t count = lanes.size(), stack = static_cast<std::size_t>(settings.stack) * kSmallSize;
  results.observations.resize(count * stack);
  if (settings.autoreset == Autoreset::kSameStep) results.final_observations.resize(count * stack);
  if (settings.screens) results.screens.resize(count * static_cast<std::size_t>(height) * kScreenWidth);
  results.ram.resize(count * kRamSize);
  for (auto* numbers : {&results.rewards, &results.lives, &results.frames, &results.episode_frames})
    numbers->resize(count);
  for (auto* flags : {&results.terminated, &results.truncated, &results.finished}) flags->resize(count);
}

void Batch::Impl::check(std::span<const int> actions) const {
  if (actions.size() != lanes.size()) {
    throw std::invalid_argument("there are " + std::to_string(actions.size()) + " actions for " +
                                std::to_string(lanes.size()) + " machines");
  }
  for (std::size_t machine = 0; machine < lanes.size(); ++machine) {
    const std::size_t count = lanes[machine]->actions().size();
    if (actions[machine] >= 0 && static_cast<std::size_t>(actions[machine]) < count) continue;
    throw std::invalid_argument("machine " + std::to_string(machine) + " has no action " +
                                std::to_string(actions[machine]) + "; it takes 0 to " +
                                std::to_string(count - 1));
  }
}

Batch::Batch(std::span<const Cartridge> cartridges, const BatchSettings& settings)
    : impl_(std::make_unique<Impl>(cartridges, settings)) {}

Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

std::size_t Batch::size() const { return impl_->lanes.size(); }
int Batch::height() const { return impl_->height; }
const std::vector<int>& Batch::actions(std::size_t machine) const {
  return impl_->lanes.at(machine)->actions();
}
const BatchResults& Batch::results() const { return impl_->results; }

void Batch::step(std::span<const int> actions) {
  impl_->check(actions);
  impl_->threads.run(size(), [this, actions](std::size_t machine) {
    impl_->lanes[machine]->step(actions[machine], impl_->results);
  });
}

void Batch::reset() {
  impl_->threads.run(size(), [this](std::size_t machine) { impl_->reset(machine); });
}

void Batch::reset(std::span<const std::uint8_t> chosen) {
  refuse_unless(chosen.size() == size(), "there are " + std::to_string(chosen.size()) + " choices for " +
                                             std::to_string(size()) + " machines");
  impl_->threads.run(size(), [this, chosen](std::size_t machine) {
    if (chosen[machine] != 0) impl_->reset(machine);
  });
}

}  // namespace racebeam
