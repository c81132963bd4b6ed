// A game in this process, with the interface that ALE has in Python. Several threads may use it, and take
// turns. Methods that need a game throw InvalidInput before one is loaded.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clients/python/core/ale_state.hpp"
#include "clients/python/core/keys.hpp"
#include "games/catalogue.hpp"

namespace racebeam::python {

// The observations of an agent after each step.
enum class View { kRgb, kGrey, kRam, kPalette, kNone };

struct StepResult {
  std::int64_t reward = 0, reward_b = 0;
  bool terminal = false, truncated = false;
  int lives = 0, episode_frame = 0, frame = 0;
};

// The actions of both players, with the strengths of their paddles.
struct Action {
  int a = 0, b = 18;
  float strength_a = 1.0F, strength_b = 0.0F;
};

class AleInterface {
 public:
  Keys& keys() { return keys_; }
  const Keys& keys() const { return keys_; }
  Lock& lock() const { return *lock_; }

  // The caller must hold lock() for this method and all below. Powers a machine on with the present keys. The
  // game is that of the key game_file, or otherwise `game`; without both, the image decides. Throws
  // InvalidInput for an unknown image, unless the key unknown_images is true.
  void load(std::shared_ptr<const Image> image, const std::optional<std::string>& game);
  bool is_loaded() const { return machine_ != nullptr; }

  Environment& environment();
  const std::shared_ptr<Machine>& machine();

  // Plays `times` acts. The reward is their sum. A long step checks for signals, such as Ctrl-C, and then
  // throws nanobind::python_error; the acts until then have been played. After the step, the observation of
  // `view` is fast to get.
  StepResult step(const Action& action, int times, View view);

  // The number of bytes of an observation, and the bytes.
  std::size_t size_of(View view);
  void copy(View view, std::span<std::uint8_t> out);

  // The settings that the machine was loaded with.
  const Keys& keys_of_machine() const { return keys_of_machine_; }
  void set_keys_of_machine(const Keys& keys) { keys_of_machine_ = keys; }

 private:
  bool acts_can_be_joined() const;

  const std::shared_ptr<Lock> lock_ = std::make_shared<Lock>();
  Keys keys_;
  Keys keys_of_machine_;
  std::shared_ptr<Machine> machine_;
};

}  // namespace racebeam::python
