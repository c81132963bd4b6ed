#include "racebeam/environment.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "environment/environment.hpp"
#include "environment/saved_state.hpp"
#include "library/internals.hpp"

namespace racebeam::v0 {

static_assert(kScreenWidth == racebeam::kScreenWidth && kRamSize == racebeam::kRamSize &&
              kAudioSize == racebeam::kAudioSize);

namespace {

// The number of an action, and its name if it has one: "1 (FIRE)".
std::string described(int action) {
  const std::string_view name = name_of(static_cast<Action>(action));
  return std::to_string(action) + (name.empty() ? "" : " (" + std::string(name) + ')');
}

}  // namespace

struct Environment::Impl {
  Impl(const racebeam::Cartridge& loaded, const Settings& settings)
      : cartridge(loaded),
        game(Internals::wrap(loaded.game)),
        machine(loaded.image, loaded.game, internal(settings)) {
    if (settings.screens != Screens::kLast) machine.set_drawing(drawing(settings.screens));
  }

  static Drawing drawing(Screens screens) {
    switch (screens) {
      case Screens::kOnDemand: return Drawing::kNone;
      case Screens::kLastTwo: return Drawing::kLastTwo;
      case Screens::kEvery: return Drawing::kEvery;
      default: return Drawing::kLast;
    }
  }

  // The mode and the difficulty stay.
  void reload(std::uint32_t seed) {
    const int mode = machine.mode(), difficulty = machine.difficulty();
    racebeam::Environment before = machine.reload(seed);
    if (mode == machine.mode() && difficulty == machine.difficulty()) return;
    try {
      machine.set_mode(mode);
      machine.set_difficulty(difficulty);
      machine.reset_game();
    } catch (...) {
      machine = std::move(before);
      throw;
    }
  }

  void reset() {
    const auto before = machine.save(true);
    try {
      machine.reset_game();
    } catch (...) {
      machine.restore(*before);
      throw;
    }
  }

  const racebeam::Cartridge cartridge;
  const Game game;
  racebeam::Environment machine;
};

Environment::Environment(const Image& image, const Settings& settings)
    : Environment(image, Game::recognise(image), settings) {}

Environment::Environment(const Image& image, const Game& game, const Settings& settings)
    : impl_(guarded(Error::Cause::kSettings,
                    [&] { return std::make_unique<Impl>(Internals::cartridge(image, game), settings); })) {}

Environment::~Environment() = default;
Environment::Environment(Environment&&) noexcept = default;
Environment& Environment::operator=(Environment&&) noexcept = default;

int Environment::step(Action a, Action b) { return step(Controls{.a = a, .b = b}); }

int Environment::step(const Controls& controls) {
  const int a = static_cast<int>(controls.a), b = static_cast<int>(controls.b);
  racebeam::Environment& machine = impl_->machine;
  require(machine.accepts({.a = a}), [a] {
    return "player A has no action " + described(a) +
           "; it must be one of a joystick, of the console, or of A's controller";
  });
  require(machine.accepts({.b = kActions + b}), [b] {
    return "player B has no action " + described(b) + "; it must be one of a joystick, or of B's controller";
  });
  for (const float strength : {controls.strength_a, controls.strength_b}) {
    require(std::isfinite(strength), [strength] {
      return "the strength of a paddle is " + std::to_string(strength) + "; it must be a finite number";
    });
  }
  if (controls.frames <= 0) return machine.act(a, kActions + b, controls.strength_a, controls.strength_b);
  return machine.act_for(controls.frames, a, kActions + b, controls.strength_a, controls.strength_b);
}

void Environment::reset(std::optional<std::uint32_t> seed) {
  guarded(Error::Cause::kArgument, [&] { seed ? impl_->reload(*seed) : impl_->reset(); });
}

Rewards Environment::rewards() const {
  const auto rewards = impl_->machine.rewards();
  const auto raw = impl_->machine.raw_rewards();
  return {rewards.a, rewards.b, raw.a, raw.b};
}

int Environment::lives() const { return impl_->machine.lives(); }
bool Environment::terminated() const { return impl_->machine.terminal(); }
bool Environment::truncated() const { return impl_->machine.truncated(); }
bool Environment::episode_over() const { return impl_->machine.game_over(); }
int Environment::frames() const { return impl_->machine.frame_number(); }
int Environment::episode_frames() const { return impl_->machine.episode_frame_number(); }

int Environment::height() const { return impl_->machine.height(); }

std::size_t Environment::observation_size(Pixels pixels) const {
  return std::size_t{kScreenWidth} * static_cast<std::size_t>(height()) * (pixels == Pixels::kRgb ? 3 : 1);
}

void Environment::observe(Pixels pixels, std::span<std::uint8_t> out) {
  if (out.size() != observation_size(pixels)) {
    throw Error(Error::Cause::kArgument, "the observation has " + std::to_string(out.size()) +
                                             " bytes; it must have " +
                                             std::to_string(observation_size(pixels)));
  }
  switch (pixels) {
    case Pixels::kRgb: return impl_->machine.screen_rgb(out);
    case Pixels::kGrey: return impl_->machine.screen_grey(out);
    case Pixels::kPalette: std::ranges::copy(screen(), out.begin());
  }
}

std::span<const std::uint8_t> Environment::screen() { return impl_->machine.screen(); }
std::span<const std::uint8_t> Environment::previous_screen() { return impl_->machine.previous_screen(); }

std::span<const std::uint8_t, kRamSize> Environment::ram() const { return impl_->machine.ram(); }
std::span<const std::uint8_t, kAudioSize> Environment::audio() const { return impl_->machine.audio(); }

void Environment::set_ram(int index, std::uint8_t value) {
  require(index >= 0 && index < kRamSize, [index] {
    return "the index of a byte of RAM is " + std::to_string(index) + "; it must be 0 to 127";
  });
  impl_->machine.set_ram(index, value);
}

Snapshot Environment::save(bool with_random) {
  Slot::Saved saved;
  saved.machine = impl_->machine.save(with_random);
  saved.with_random = with_random;
  return Internals::wrap(impl_->cartridge, impl_->machine.settings(), std::move(saved), false);
}

void Environment::restore(const Snapshot& snapshot) {
  guarded(Error::Cause::kSnapshot,
          [&] { impl_->machine.restore(*Internals::saved(snapshot, impl_->machine).machine); });
}

std::uint64_t Environment::state_hash() { return impl_->machine.state_hash(); }

const Game& Environment::game() const { return impl_->game; }
void Environment::set_mode(int mode) {
  guarded(Error::Cause::kArgument, [&] { impl_->machine.set_mode(mode); });
}
void Environment::set_difficulty(int difficulty) {
  guarded(Error::Cause::kArgument, [&] { impl_->machine.set_difficulty(difficulty); });
}

void Environment::on_frame(std::function<void()> function) { impl_->machine.watch(std::move(function)); }

}  // namespace racebeam::v0
