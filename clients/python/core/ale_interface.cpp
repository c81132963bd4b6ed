#include "clients/python/core/ale_interface.hpp"

#include <algorithm>
#include <limits>

#include "clients/python/core/signals.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::python {
namespace {

constexpr int kFramesWithoutSignals = 2000;  // they take some tens of milliseconds

Drawing drawing_for(View view, bool averages) {
  if (view == View::kRam || view == View::kNone) return Drawing::kNone;
  return averages ? Drawing::kLastTwo : Drawing::kLast;
}

}  // namespace

void AleInterface::load(std::shared_ptr<const Image> image, const std::optional<std::string>& game) {
  const std::string& file = keys_.strings.at("game_file");
  const Recognition found =
      file.empty() ? recognise(*image, game) : recognise(*image, std::nullopt, std::optional(file));
  if (!found.game->has_rule() && file.empty() && !keys_.bools.at("unknown_images"))
    throw InvalidInput("no game is known for the image " + image->stem + " with MD5 " + image->md5 +
                       "; name the game whose rule it has, or use an image that `racebeam games` lists");
  auto rules = with_overrides(found.game, *image, keys_.console());
  machine_ = std::make_shared<Machine>(lock_, std::move(image), std::move(rules), keys_.settings());
  machine_->environment.make_all_audio(keys_.bools.at("all_audio"));
  // As in ALE, a value that a game forces stays in effect for images that are loaded later.
  if (const int forced = machine_->environment.game().paddle_max; forced != -1)
    keys_.ints.at("paddle_max") = forced;
  keys_of_machine_ = keys_;
}

const std::shared_ptr<Machine>& AleInterface::machine() {
  if (!machine_) throw InvalidInput("ROM not set: load an image first");
  return machine_;
}

Environment& AleInterface::environment() { return machine()->environment; }

// Returns whether one long act has the results of several acts. It has unless rewards are clipped, acts have
// sound samples, or an act has several frames.
bool AleInterface::acts_can_be_joined() const {
  const Settings& settings = machine_->environment.settings();
  return settings.frame_skip <= 1 && !settings.sound &&
         settings.reward_min == std::numeric_limits<int>::min() &&
         settings.reward_max == std::numeric_limits<int>::max();
}

StepResult AleInterface::step(const Action& action, int times, View view) {
  Environment& machine = environment();
  machine.set_drawing(drawing_for(view, machine.settings().color_averaging));
  machine.begin_audio();
  StepResult result;
  const int most = acts_can_be_joined() ? kFramesWithoutSignals : 1;
  for (int remaining = times, since_signals = 0; remaining > 0;) {
    const int acts = std::min(remaining, most);
    if (most > 1) {
      machine.act_for(acts, action.a, action.b, action.strength_a, action.strength_b);
    } else {
      machine.act(action.a, action.b, action.strength_a, action.strength_b);
    }
    result.reward += machine.rewards().a;
    result.reward_b += machine.rewards().b;
    remaining -= acts;
    since_signals += acts;
    if (remaining > 0 && since_signals >= kFramesWithoutSignals) {
      since_signals = 0;
      look_for_signals();
    }
  }
  result.terminal = machine.terminal();
  result.truncated = machine.truncated();
  result.lives = machine.lives();
  result.episode_frame = machine.episode_frame_number();
  result.frame = machine.frame_number();
  return result;
}

std::size_t AleInterface::size_of(View view) {
  const auto pixels = static_cast<std::size_t>(environment().height()) * kScreenWidth;
  switch (view) {
    case View::kRgb: return 3 * pixels;
    case View::kRam: return kRamSize;
    case View::kNone: return 0;
    default: return pixels;
  }
}

void AleInterface::copy(View view, std::span<std::uint8_t> out) {
  const Environment& machine = environment();
  switch (view) {
    case View::kRgb: return machine.screen_rgb(out);
    case View::kGrey: return machine.screen_grey(out);
    case View::kRam: std::ranges::copy(machine.ram(), out.begin()); return;
    case View::kPalette: std::ranges::copy(machine.screen(), out.begin()); return;
    case View::kNone: return;
  }
}

}  // namespace racebeam::python
