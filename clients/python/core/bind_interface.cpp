#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>

#include "clients/python/core/ale_interface.hpp"
#include "clients/python/core/arrays.hpp"
#include "clients/python/core/bindings.hpp"
#include "clients/python/core/gil.hpp"
#include "clients/python/core/image_argument.hpp"
#include "clients/python/core/python_action.hpp"
#include "environment/input/has_paddles.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::python {
namespace {

using namespace nb::literals;

// Makes a method of Python that reads a number or a list of the environment.
template <auto method>
auto ask(AleInterface& self) {
  const Turn turn(self.lock());
  return (self.environment().*method)();
}

// Pictures and other bytes

// Returns the shape of an observation.
std::vector<std::size_t> shape_of(const Environment& environment, View view) {
  const auto height = static_cast<std::size_t>(environment.height());
  switch (view) {
    case View::kRgb: return {height, kScreenWidth, 3};
    case View::kRam: return {kRamSize};
    default: return {height, kScreenWidth};
  }
}

Bytes array_of(FreshBytes&& bytes, View view, std::size_t height) {
  switch (view) {
    case View::kRgb: return std::move(bytes).array({height, kScreenWidth, 3});
    case View::kRam: return std::move(bytes).array({kRamSize});
    default: return std::move(bytes).array({height, kScreenWidth});
  }
}

template <View view>
Bytes fresh(AleInterface& self) {
  FreshBytes bytes;
  std::size_t height = 0;
  {
    const Turn turn(self.lock());
    bytes = FreshBytes(self.size_of(view));
    height = static_cast<std::size_t>(self.environment().height());
    self.copy(view, bytes.span());
  }
  return array_of(std::move(bytes), view, height);
}

template <class Numbers>
std::string in_brackets(const Numbers& numbers) {
  std::string text;
  for (const auto number : numbers) text += (text.empty() ? "" : ", ") + std::to_string(number);
  return "(" + text + ")";
}

void check_shape(const Buffer& buffer, const std::vector<std::size_t>& expected) {
  const std::vector<std::size_t> shape(buffer.shape_ptr(), buffer.shape_ptr() + buffer.ndim());
  if (shape != expected)
    throw InvalidInput("Invalid shape " + in_brackets(shape) + ", expecting shape " + in_brackets(expected));
}

template <View view>
void into(AleInterface& self, const Buffer& buffer) {
  const Turn turn(self.lock());
  check_shape(buffer, shape_of(self.environment(), view));
  self.copy(view, {buffer.data(), buffer.size()});
}

template <std::size_t size>
using Fixed = nb::ndarray<std::uint8_t, nb::shape<size>, nb::c_contig, nb::device::cpu>;

template <std::size_t size>
using FreshFixed = nb::ndarray<nb::numpy, std::uint8_t, nb::shape<size>>;

void copy_audio(AleInterface& self, std::span<std::uint8_t> out) {
  const Turn turn(self.lock());
  std::ranges::copy(self.environment().audio(), out.begin());
}

FreshBytes all_audio(AleInterface& self) {
  const Turn turn(self.lock());
  const auto samples = self.environment().all_audio();
  FreshBytes bytes(samples.size());
  std::ranges::copy(samples, bytes.span().begin());
  return bytes;
}

void bind_bytes(nb::class_<AleInterface>& interface) {
  const auto bind = [&interface]<View view>(const char* name, const char* what) {
    interface.def(name, fresh<view>, what)
        .def(name, into<view>, "buffer"_a.noconvert(), "Writes into an array of the caller.");
  };
  bind.operator()<View::kPalette>("getScreen", "height x 160 numbers of colours.");
  bind.operator()<View::kRgb>("getScreenRGB", "height x 160 x 3.");
  bind.operator()<View::kGrey>("getScreenGrayscale", "height x 160.");
  interface.def("getRAM", [](AleInterface& self) { return FreshFixed<kRamSize>(fresh<View::kRam>(self)); })
      .def(
          "getRAM",
          [](AleInterface& self, const Fixed<kRamSize>& buffer) {
            const Turn turn(self.lock());
            self.copy(View::kRam, {buffer.data(), buffer.size()});
          },
          "buffer"_a.noconvert())
      .def(
          "getAudio",
          [](AleInterface& self) {
            FreshBytes bytes(kAudioSize);
            copy_audio(self, bytes.span());
            return FreshFixed<kAudioSize>(std::move(bytes).array({kAudioSize}));
          },
          "Returns the samples of the last act, or zeros if sound_obs was False when the image was loaded.")
      .def(
          "getAudio",
          [](AleInterface& self, const Fixed<kAudioSize>& buffer) {
            copy_audio(self, {buffer.data(), buffer.size()});
          },
          "buffer"_a.noconvert())
      .def(
          "getAllAudio",
          [](AleInterface& self) {
            FreshBytes bytes = all_audio(self);
            const std::size_t size = bytes.size();
            return std::move(bytes).array({size});
          },
          "Returns 512 samples for each frame of the last step(), if all_audio was True when the image was "
          "loaded.");
}

// Acting

template <class Enumeration>
int number_of(Enumeration action) {
  return static_cast<int>(action);
}

[[noreturn]] void refuse(int action, const char* accepted) {
  throw InvalidInput("action " + std::to_string(action) + " is out of range; accepted: " + accepted);
}

// Refuses numbers that are not actions. The environment would take some of them for NOOP, as the reference
// does.
void check_actions(const Environment& environment, int a, int b = kActions) {
  if (!environment.accepts({.a = a})) refuse(a, "0 to 25, and those of the left controller");
  if (!environment.accepts({.b = b})) refuse(b, "18 to 35, and those of the right controller");
}

void check_strength(float strength) {
  if (!std::isfinite(strength))
    throw InvalidInput("a paddle's strength is " + std::to_string(strength) + "; it must be a finite number");
}

int act(AleInterface& self, int action, float strength) {
  check_strength(strength);
  const Turn turn(self.lock());
  Environment& environment = self.environment();
  check_actions(environment, action);
  environment.set_drawing(environment.settings().color_averaging ? Drawing::kLastTwo : Drawing::kLast);
  return environment.act(action, kActions, strength);
}

// Returns the observation, both rewards, terminated, truncated, lives, frames of the episode and frames since
// loading. It is one call, since each call of Python takes time.
nb::tuple step(AleInterface& self, int action, float strength, int times, View view, int action_b,
               float strength_b) {
  if (times < 1) throw InvalidInput("times is " + std::to_string(times) + "; it must be 1 or more");
  check_strength(strength);
  check_strength(strength_b);
  FreshBytes bytes;
  StepResult result;
  std::size_t height = 0;
  {
    const Turn turn(self.lock());
    check_actions(self.environment(), action, action_b);
    result = self.step({action, action_b, strength, strength_b}, times, view);
    bytes = FreshBytes(self.size_of(view));
    height = static_cast<std::size_t>(self.environment().height());
    self.copy(view, bytes.span());
  }
  nb::object observation =
      view == View::kNone ? nb::none() : nb::cast(array_of(std::move(bytes), view, height));
  return nb::make_tuple(std::move(observation), static_cast<double>(result.reward),
                        static_cast<double>(result.reward_b), result.terminal, result.truncated, result.lives,
                        result.episode_frame, result.frame);
}

bool game_over(AleInterface& self, bool with_truncation) {
  const Turn turn(self.lock());
  return with_truncation ? self.environment().game_over() : self.environment().terminal();
}

void set_ram(AleInterface& self, unsigned index, std::uint8_t value) {
  if (index >= kRamSize)
    throw InvalidInput("setRAM index out of bounds: " + std::to_string(index) + "; it takes 0 to 127");
  const Turn turn(self.lock());
  self.environment().set_ram(static_cast<int>(index), value);
}

std::vector<PythonAction> as_actions(const std::vector<int>& numbers) {
  std::vector<PythonAction> actions;
  for (const int number : numbers) actions.push_back(static_cast<PythonAction>(number));
  return actions;
}

void bind_play(nb::class_<AleInterface>& interface) {
  interface
      .def("act", [](AleInterface& self, unsigned action, float strength) {
            if (action >= kActions) refuse(static_cast<int>(std::min(action, 1U << 30)), "0 to 17");
            return act(self, static_cast<int>(action), strength);
          }, "action"_a, "paddle_strength"_a = 1.0F)
      .def("act", [](AleInterface& self, PythonAction action, float strength) {
            return act(self, number_of(action), strength);
          }, "action"_a, "paddle_strength"_a = 1.0F)
      .def("act", [](AleInterface& self, PythonConsoleAction action, float strength) {
            return act(self, number_of(action), strength);
          }, "action"_a, "paddle_strength"_a = 1.0F)
      .def("act", [](AleInterface& self, PythonControllerAction action, float strength) {
            return act(self, number_of(action), strength);
          }, "action"_a, "paddle_strength"_a = 1.0F)
      .def("step", step, "action"_a, "paddle_strength"_a, "times"_a, "view"_a, "action_b"_a = kActions,
           "paddle_strength_b"_a = 0.0F,
           nb::sig("def step(self, action: int, paddle_strength: float, times: int, view: View, action_b: int = 18, "
                   "paddle_strength_b: float = 0.0) -> tuple[typing.Any, float, float, bool, bool, int, int, int]"),
           "Plays the action `times` times. Returns the view, the rewards of both players, terminated, truncated, lives, frames "
           "of the episode and since loading.")
      .def("reset_game", ask<&Environment::reset_game>)
      .def("game_over", game_over, "with_truncation"_a = true)
      .def("game_truncated", ask<&Environment::truncated>)
      .def("lives", ask<&Environment::lives>)
      .def("getFrameNumber", ask<&Environment::frame_number>)
      .def("getEpisodeFrameNumber", ask<&Environment::episode_frame_number>)
      .def("getScreenDims", [](AleInterface& self) { return std::tuple(ask<&Environment::height>(self), kScreenWidth); })
      .def("getRAMSize", [](AleInterface&) { return kRamSize; })
      .def("getAudioSize", [](AleInterface&) { return kAudioSize; })
      .def("setRAM", set_ram, "index"_a, "value"_a)
      .def("state_hash", ask<&Environment::state_hash>, "Returns a hash of the state. Games with equal hashes continue equally.");
}

// The game

using ListOfGame = std::vector<int> Game::*;

template <ListOfGame list>
std::vector<int> list_of(AleInterface& self) {
  const Turn turn(self.lock());
  return self.environment().game().*list;
}

// Calls a setter. Its error begins with ALE's words, and the accepted values follow.
template <auto method>
void change(AleInterface& self, int value, const std::string& words) {
  const Turn turn(self.lock());
  try {
    (self.environment().*method)(value);
  } catch (const InvalidInput& error) {
    throw InvalidInput(words + ": " + error.what());
  }
}

void set_mode(AleInterface& self, int mode) {
  change<&Environment::set_mode>(self, mode, "Invalid game mode requested");
}

void set_difficulty(AleInterface& self, int difficulty) {
  change<&Environment::set_difficulty>(self, difficulty, "Invalid difficulty requested");
}

std::optional<std::string> supported(const ImageArgument& where) {
  const auto game = find_game_by_md5(image_of(where, "bytes")->md5);
  return game && game->has_rule() ? std::optional(game->name) : std::nullopt;
}

void load(AleInterface& self, const ImageArgument& where, const std::optional<std::string>& game) {
  const Turn turn(self.lock());
  const auto image = image_of(where, game.value_or("bytes"));
  self.load(image, game);
  const auto* const path = std::get_if<std::filesystem::path>(&where);
  self.keys().strings["rom_file"] = path != nullptr ? path->string() : "";
}

void bind_game(nb::class_<AleInterface>& interface) {
  interface.def("loadROM", load, "rom"_a, "game"_a = nb::none(),
                nb::sig("def loadROM(self, rom: str | os.PathLike[str] | bytes, game: str | None = None) -> None"),
                "Powers the machine on. rom: a path, builtin:NAME, or the bytes of an image. game: whose rule it has; "
                "None: the image decides.")
      .def_static("isSupportedROM", supported, "rom"_a, nb::call_guard<WithoutGil>(),
                  nb::sig("def isSupportedROM(rom: str | os.PathLike[str] | bytes) -> str | None"),
                  "Returns the name of the image's game, or None.")
      .def_static("setLoggerMode", [](LoggerMode) {}, "mode"_a)
      .def_static("setLoggerMode", [](int) {}, "mode"_a)
      .def("getLegalActionSet", [](AleInterface& self) { return as_actions(list_of<&Game::legal_actions>(self)); })
      .def("getMinimalActionSet", [](AleInterface& self) { return as_actions(list_of<&Game::minimal_actions>(self)); })
      .def("getAvailableModes", list_of<&Game::modes>)
      .def("getAvailableDifficulties", list_of<&Game::difficulties>)
      .def("getTwoPlayerModes", list_of<&Game::two_player_modes>, "Returns the modes for two players.")
      .def("getMode", ask<&Environment::mode>)
      .def("getDifficulty", ask<&Environment::difficulty>)
      .def("setMode", set_mode, "mode"_a)
      .def("setDifficulty", set_difficulty, "difficulty"_a)
      .def("getGame", [](AleInterface& self) {
            const Turn turn(self.lock());
            return self.environment().game().name;
          }, "Returns the name of the game.")
      .def("getControllers", [](AleInterface& self) {
            const Turn turn(self.lock());
            const Properties properties = properties_of(self.environment());
            return std::tuple(std::string(word_for(kControllers, properties.left)),
                              std::string(word_for(kControllers, properties.right)));
          }, "Returns the names of the controllers of players A and B, such as \"joystick\".")
      .def("image_warning", [](AleInterface& self) {
            const Turn turn(self.lock());
            return image_warning(self.environment().game(), self.environment().image());
          }, "Returns a warning if the game's rule was written for another image, or it is doubtful whether it runs.");
}

// States

AleState clone(AleInterface& self, bool with_random) {
  const Turn turn(self.lock());
  return AleState(self.machine(), with_random);
}

void restore(AleInterface& self, const AleState& state) {
  const Turn turn(self.lock());
  state.restore_in(self.environment());
}

void bind_states(nb::class_<AleInterface>& interface) {
  interface.def("cloneState", clone, "include_rng"_a = false)
      .def("restoreState", restore, "state"_a)
      .def("cloneSystemState", [](AleInterface& self) { return clone(self, true); })
      .def("restoreSystemState", restore, "state"_a);
}

// Settings

template <class Value>
Value get(AleInterface& self, Keys::Table<Value> Keys::*table, std::string_view key, Value otherwise) {
  const Turn turn(self.lock());
  const auto found = (self.keys().*table).find(key);
  return found == (self.keys().*table).end() ? otherwise : found->second;
}

template <class Value>
void set(AleInterface& self, Keys::Table<Value> Keys::*table, std::string_view key, const Value& value) {
  const Turn turn(self.lock());
  const auto found = (self.keys().*table).find(key);
  if (found == (self.keys().*table).end())
    throw InvalidInput("The key " + std::string(key) +
                       " you are trying to set does not exist or has incorrect value type.");
  found->second = value;
}

template <class Value, Keys::Table<Value> Keys::*table>
void bind_type(nb::class_<AleInterface>& interface, const char* getter, const char* setter,
               const Value& otherwise) {
  interface
      .def(getter, [otherwise](AleInterface& self, std::string_view key) { return get(self, table, key, otherwise); },
           "key"_a)
      .def(setter, [](AleInterface& self, std::string_view key, const Value& value) { set(self, table, key, value); },
           "key"_a, "value"_a);
}

void bind_keys(nb::class_<AleInterface>& interface) {
  bind_type<int, &Keys::ints>(interface, "getInt", "setInt", -1);
  bind_type<bool, &Keys::bools>(interface, "getBool", "setBool", false);
  bind_type<float, &Keys::floats>(interface, "getFloat", "setFloat", -1.0F);
  bind_type<std::string, &Keys::strings>(interface, "getString", "setString", "");
}

}  // namespace

void bind_interface(nb::module_& module) {
  nb::class_<AleInterface> interface(
      module, "ALEInterface", "One game in this process. Settings take effect when an image is loaded.");
  interface.def(nb::init<>());
  bind_pickling(interface);
  bind_game(interface);
  bind_play(interface);
  bind_bytes(interface);
  bind_states(interface);
  bind_keys(interface);
  module.def("state_hash", ask<&Environment::state_hash>, "interface"_a,
             "Returns the hash of the machine's state, as logs of episodes have it.");
}

}  // namespace racebeam::python
