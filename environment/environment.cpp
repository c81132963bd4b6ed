#include "environment/environment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "emulator/base/mersenne_twister.hpp"
#include "emulator/tia/palette.hpp"
#include "emulator/tia/registers/register_values.hpp"
#include "environment/impl.hpp"
#include "environment/reset/classic_power_on.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

PaddleLimits paddle_limits(const Settings& settings, const Game& game) {
  PaddleLimits limits;
  if (settings.paddle_min != -1) limits.min = settings.paddle_min;
  if (settings.paddle_max != -1) limits.max = settings.paddle_max;
  if (game.paddle_max != -1) limits.max = game.paddle_max;
  return limits;
}

std::shared_ptr<const Game> by_settings(std::shared_ptr<const Game> game, const Settings& settings) {
  if (settings.classic && game->classic) game = game->classic;
  return settings.rules == Rules::kFixed && game->fixed ? game->fixed : game;
}

void refuse_unless(bool good, const std::string& sentence) {
  if (!good) throw InvalidInput(sentence);
}

const Settings& checked(const Settings& settings, const Game& game) {
  refuse_unless(settings.frame_skip >= 0,
                "frame_skip is " + std::to_string(settings.frame_skip) + "; it must be 1 or more");
  refuse_unless(!std::isnan(settings.sticky), "the probability of sticky actions is not a number");
  refuse_unless(settings.reward_min <= settings.reward_max,
                "reward_min (" + std::to_string(settings.reward_min) + ") is above reward_max (" +
                    std::to_string(settings.reward_max) + ")");
  const PaddleLimits limits = paddle_limits(settings, game);
  refuse_unless(limits.min >= 0 && limits.min <= limits.max, "paddle_min (" + std::to_string(limits.min) +
                                                                 ") must be between 0 and paddle_max (" +
                                                                 std::to_string(limits.max) + ")");
  return settings;
}

std::unique_ptr<PowerOn> make_power_on(const Settings& settings, MersenneTwister& random) {
  if (settings.classic) return std::make_unique<ClassicPowerOn>(random);
  return std::make_unique<SystemGenerator>(settings.system_seed);
}

void check_offered(int number, const std::vector<int>& offered, const std::string& what, const Game& game) {
  if (std::ranges::find(offered, number) != offered.end()) return;
  std::string list;
  for (const int one : offered) list += (list.empty() ? "" : ", ") + std::to_string(one);
  throw InvalidInput(game.name + " has no " + what + " " + std::to_string(number) + "; it offers " + list);
}

std::size_t ram_index(int index) {
  if (index >= 0 && index < kRamSize) return static_cast<std::size_t>(index);
  throw std::out_of_range("index " + std::to_string(index) + " of RAM is out of range; accepted: 0 to 127");
}

}  // namespace

Environment::Impl::Impl(std::shared_ptr<const Image> image_given, std::shared_ptr<const Game> game_given,
                        const Settings& settings_given, Pace* pace_given)
    : image(std::move(image_given)),
      game(by_settings(std::move(game_given), settings_given)),
      settings(checked(settings_given, *game)),
      pace(pace_given),
      identity(*image, *game),
      properties(game->properties_for(image->md5)),
      random(settings.random_seed),
      power_on(make_power_on(settings, random)),
      console(image->bytes, properties, *power_on, settings.cpu, pace),
      rule(*game),
      legal(game->legal_actions, properties.left, properties.right),
      sticky(settings.sticky),
      controller_input(properties, paddle_limits(settings, *game)),
      lives_at_start(rule.initial_lives()),
      drawing(settings.color_averaging ? Drawing::kLastTwo : Drawing::kLast),
      blend(settings.color_averaging ? &racebeam::blend(console.format()) : nullptr) {
  random.seed(settings.random_seed);  // in classic mode the console has drawn from it
  play.mode = game->default_mode;
  reset();
}

std::span<const std::uint8_t> Environment::Impl::screen() {
  if (blend == nullptr) return console.picture();
  if (blend_is_due) {
    blended.resize(console.picture().size());
    (*blend)(console.picture(), console.previous_picture(), blended);
    blend_is_due = false;
  }
  return blended;
}

Environment::Environment(std::shared_ptr<const Image> image, std::shared_ptr<const Game> game,
                         const Settings& settings, Pace* pace)
    : impl_(std::make_unique<Impl>(std::move(image), std::move(game), settings, pace)) {}

Environment::Environment(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Environment::~Environment() = default;
Environment::Environment(Environment&&) noexcept = default;
Environment& Environment::operator=(Environment&&) noexcept = default;

void Environment::watch(std::function<void()> each_frame) { impl_->each_frame = std::move(each_frame); }

void Environment::set_drawing(Drawing drawing) { impl_->drawing = drawing; }
Drawing Environment::drawing() const { return impl_->drawing; }

void Environment::release_caches() { impl_->console.release_caches(); }

std::size_t Environment::footprint() const {
  return impl_->console.footprint() + impl_->open_picture.capacity() + impl_->blended.capacity() +
         impl_->all_audio.capacity();
}

std::size_t Environment::cartridge_ram_size() const { return impl_->console.cartridge_ram().size(); }

void Environment::reset_game() { impl_->reset(); }

Environment Environment::reload(std::uint32_t random_seed) {
  Settings settings = impl_->settings;
  settings.random_seed = random_seed;
  auto anew = std::make_unique<Impl>(impl_->image, impl_->game, settings, impl_->pace);
  anew->each_frame = impl_->each_frame;
  anew->drawing = impl_->drawing;
  anew->makes_all_audio = impl_->makes_all_audio;
  return Environment(std::exchange(impl_, std::move(anew)));
}

void Environment::set_mode(int mode) {
  check_offered(mode, game().offered_modes(), "mode", game());
  impl_->play.mode = mode;
}

void Environment::set_difficulty(int difficulty) {
  check_offered(difficulty, game().difficulties, "difficulty", game());
  impl_->play.switches.set_difficulty(difficulty);
}

int Environment::mode() const { return impl_->play.mode; }
int Environment::difficulty() const { return impl_->play.switches.difficulty; }

Environment::RawRewards Environment::raw_rewards() const { return impl_->raw_rewards; }
Environment::Rewards Environment::rewards() const { return {impl_->play.rewards[0], impl_->play.rewards[1]}; }

bool Environment::game_over() const { return impl_->over(); }
bool Environment::terminal() const { return impl_->rule.terminal(); }
bool Environment::truncated() const { return impl_->truncated(); }
int Environment::lives() const { return impl_->rule.lives(); }
int Environment::frame_number() const { return static_cast<int>(impl_->play.frames); }
int Environment::episode_frame_number() const { return static_cast<int>(impl_->play.episode_frames); }

int Environment::height() const { return impl_->console.height(); }
std::span<const std::uint8_t> Environment::screen() const { return impl_->screen(); }
std::span<const std::uint8_t> Environment::previous_screen() const {
  if (impl_->frame_continues) return impl_->open_picture;
  return impl_->console.previous_picture();
}
std::span<const std::uint64_t> Environment::screen_lines() const {
  if (impl_->blend != nullptr) return {};
  return impl_->console.picture_lines();
}
std::span<const std::uint64_t> Environment::previous_screen_lines() const {
  if (impl_->frame_continues) return {};
  return impl_->console.previous_picture_lines();
}
Format Environment::format() const { return impl_->console.format(); }
const Sound& Environment::sound() const { return impl_->console.sound(); }
std::span<const std::uint8_t, kAudioSize> Environment::audio() const { return impl_->audio; }
std::span<const std::uint8_t> Environment::all_audio() const { return impl_->all_audio; }
void Environment::make_all_audio(bool all) { impl_->makes_all_audio = all; }
void Environment::begin_audio() { impl_->all_audio.clear(); }

std::span<const std::uint8_t, kRamSize> Environment::ram() const {
  if (impl_->play.ram_is_stale != 0) return impl_->play.stale_ram;
  return impl_->console.ram();
}

void Environment::set_ram(int index, std::uint8_t value) {
  const std::size_t at = ram_index(index);
  impl_->console.set_ram(index, value);
  impl_->play.stale_ram[at] = value;
}

void Environment::tia_values(std::vector<std::uint8_t>& values) const {
  const auto found = racebeam::tia_values(impl_->console.state(), sound());
  values.assign(found.begin(), found.end());
}

void Environment::screen_rgb(std::vector<std::uint8_t>& rgb) const {
  rgb.resize(3 * screen().size());
  screen_rgb(std::span(rgb));
}

void Environment::screen_grey(std::vector<std::uint8_t>& grey) const {
  grey.resize(screen().size());
  screen_grey(std::span(grey));
}

// Four bytes are written for a pixel, which is faster than three; the next pixel overwrites the fourth.
void Environment::screen_rgb(std::span<std::uint8_t> rgb) const {
  static_assert(sizeof(Rgb) == 3);
  const Palette& colours = palette(impl_->console.format());
  std::array<std::uint32_t, 256> wide{};
  for (std::size_t i = 0; i < wide.size(); ++i) std::memcpy(&wide[i], &colours[i], sizeof(Rgb));
  const auto pixels = screen();
  std::uint8_t* out = rgb.data();
  for (const std::uint8_t pixel : pixels.first(pixels.size() - 1)) {
    std::memcpy(out, &wide[pixel], sizeof wide[pixel]);
    out += sizeof(Rgb);
  }
  std::memcpy(out, &colours[pixels.back()], sizeof(Rgb));
}

void Environment::screen_grey(std::span<std::uint8_t> grey) const {
  const GreyTable& table = grey_table(impl_->console.format());
  std::ranges::transform(screen(), grey.begin(), [&](std::uint8_t pixel) { return table[pixel]; });
}

const Game& Environment::game() const { return *impl_->game; }
const Image& Environment::image() const { return *impl_->image; }
const Settings& Environment::settings() const { return impl_->settings; }

std::shared_ptr<const FrameBuffer> Environment::with_pixels(
    const std::shared_ptr<FrameBuffer>& picture) const {
  return impl_->console.with_pixels(picture);
}

std::shared_ptr<const Environment::Saved> Environment::save(bool with_random) const {
  return impl_->save(with_random);
}
std::uint64_t Environment::state_hash() const { return racebeam::state_hash(impl_->parts()); }
bool Environment::same_state(const Environment& other) const {
  return impl_->identity == other.impl_->identity &&
         racebeam::same_state(impl_->parts(), other.impl_->parts());
}

void Environment::restore(const Saved& saved) { impl_->restore(saved); }
void Environment::check(const Saved& saved) const { impl_->check_values(saved); }
std::shared_ptr<const Environment::Saved> Environment::save_without_pictures() const {
  return impl_->save_without_pictures();
}
void Environment::restore_classic(const Saved& saved) { impl_->restore_classic(saved); }

}  // namespace racebeam
