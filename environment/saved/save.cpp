// States in memory: copies of values, and pictures that are shared until they are drawn on again
// (docs/spec/environment.md, 13, for what the reference leaves out).
#include <algorithm>

#include "environment/impl.hpp"
#include "environment/saved/saved_state_check.hpp"
#include "system/invalid_input.hpp"
#include "system/printable.hpp"

namespace racebeam {
namespace {

void put(std::span<char> field, const std::string& text) {
  std::copy_n(text.begin(), std::min(text.size(), field.size()), field.begin());
}

// Replaces control bytes, since the state may come from an untrusted source.
std::string text_of(std::span<const char> field) {
  const auto end = std::ranges::find(field, '\0');
  return printable({field.data(), static_cast<std::size_t>(end - field.begin())});
}

}  // namespace

Identity::Identity(const Image& image, const Game& its_game) {
  put(md5, image.md5);
  put(game, its_game.is_fixed ? its_game.name + " with fixed rules" : its_game.name);
}

std::string Identity::md5_text() const { return text_of(md5); }
std::string Identity::game_name() const { return text_of(game); }

void check_identity(const Identity& saved, const Identity& running) {
  if (saved.md5 != running.md5) {
    throw InvalidInput("the state is of the image with MD5 " + saved.md5_text() +
                       "; the one that runs has MD5 " + running.md5_text());
  }
  if (saved.game != running.game) {
    throw InvalidInput("the state is of the game " + saved.game_name() + "; the one that runs is " +
                       running.game_name());
  }
}

std::shared_ptr<Environment::Saved> Environment::Impl::save_without_pictures() const {
  auto saved = std::make_shared<Saved>();
  saved->identity = identity;
  saved->values = {console.state(), play, rule.state(), console.sound(), audio};
  saved->cartridge_ram.assign(console.cartridge_ram().begin(), console.cartridge_ram().end());
  saved->properties = properties;
  saved->height = console.height();
  return saved;
}

std::shared_ptr<const Environment::Saved> Environment::Impl::save(bool with_random) const {
  auto saved = save_without_pictures();
  saved->pictures = console.pictures();
  if (with_random) saved->random = std::make_shared<const MersenneTwister>(random);
  return saved;
}

void Environment::Impl::restore(const Saved& saved) {
  check(saved);
  console.restore(saved.values.machine, saved.cartridge_ram);
  if (saved.pictures.current) console.restore_pictures(saved.pictures);
  console.sound() = saved.values.sound;
  rule.restore(saved.values.rule);
  play = saved.values.play;
  audio = saved.values.audio;
  all_audio.clear();
  raw_rewards = {};
  if (saved.random) random = *saved.random;
  blend_is_due = true;
  frame_continues = false;
}

// Two game files can have the same name and different properties.
void Environment::Impl::check(const Saved& saved) const {
  check_identity(saved.identity, identity);
  if (saved.properties == properties && saved.height == console.height()) return;
  throw InvalidInput(
      "the state is of a console with another picture or other controllers than the one that runs");
}

void Environment::Impl::check_values(const Saved& saved) const {
  const Saved::Values& values = saved.values;
  console.check(values.machine, saved.cartridge_ram);
  check_play(values.play, *game);
  check_rule_state(values.rule, *game);
  check_sound(values.sound);
}

// The reference copies RAM only after a frame. Its states do not contain pictures, sound and sticky actions;
// in 0.6, nor how far the current frame has come.
void Environment::Impl::restore_classic(const Saved& saved) {
  check(saved);
  EpisodeState restored = saved.values.play;
  restored.held = play.held;
  restored.ram_is_stale = 1;
  restored.stale_ram = play.stale_ram;
  if (play.ram_is_stale == 0) std::ranges::copy(console.ram(), restored.stale_ram.begin());
  const State& now = console.state();
  State machine = saved.values.machine;
  machine.frame.open = now.frame.open;
  machine.frame.greyed = now.frame.greyed;
  machine.tia.pixel = now.tia.pixel;
  console.restore(machine, saved.cartridge_ram);
  rule.restore(saved.values.rule);
  play = restored;
}

}  // namespace racebeam
