// VectorMachines: their results go into arrays that Python made.
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <stdexcept>

#include "clients/python/core/arrays.hpp"
#include "clients/python/core/bindings.hpp"
#include "clients/python/core/gil.hpp"
#include "clients/python/core/image_argument.hpp"
#include "clients/python/core/saved_machine.hpp"
#include "clients/python/core/vector_acts.hpp"
#include "clients/python/core/vector_machines.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::python {
namespace {

using namespace nb::literals;

template <class T>
using Given = nb::ndarray<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Joysticks = nb::ndarray<const float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
template <class T>
using Rows = nb::ndarray<T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// The members of racebeam.vector.results.Results, in their order.
using Results = std::tuple<std::optional<Buffer>, std::optional<Buffer>, Rows<std::int32_t>, Rows<bool>,
                           std::optional<Buffer>, std::optional<Rows<std::int32_t>>,
                           std::optional<Rows<std::int32_t>>, std::optional<Buffer>, std::optional<Buffer>>;

template <class T>
std::span<const T> span_of(const Given<T>& array) {
  return {array.data(), array.size()};
}

template <class T>
std::span<const T> span_of(const std::optional<Given<T>>& array) {
  return array ? span_of(*array) : std::span<const T>();
}

std::span<std::uint8_t> bytes_of(const std::optional<Buffer>& array, std::size_t size) {
  if (!array) return {};
  if (array->size() != size)
    throw InvalidInput("an array of results has " + std::to_string(array->size()) + " bytes; it must have " +
                       std::to_string(size));
  return {array->data(), size};
}

// Gives each of `parts` a row of `count` values.
template <class T, class Part, std::size_t size>
void share_out(const Rows<T>& rows, std::size_t count, const std::array<std::span<Part>*, size>& parts) {
  static_assert(sizeof(T) == sizeof(Part));
  if (rows.shape(0) != size || rows.shape(1) != count)
    throw InvalidInput("an array of results has " + std::to_string(rows.shape(0)) + " rows of " +
                       std::to_string(rows.shape(1)) + " values; it must have " + std::to_string(size) +
                       " of " + std::to_string(count));
  for (std::size_t row = 0; row < size; ++row)
    *parts[row] = {reinterpret_cast<Part*>(rows.data()) + row * count, count};
}

BatchArrays arrays_of(const Batch& batch, std::size_t count, const Results& results) {
  const auto& [observations, ram, numbers, flags, final_observations, final_numbers, played, audio,
               final_audio] = results;
  const std::size_t screens = count * batch.observation_size();
  BatchArrays to;
  to.observations = bytes_of(observations, screens);
  to.ram = bytes_of(ram, count * kRamSize);
  to.audio = bytes_of(audio, count * batch.audio_size());
  to.final_audio = bytes_of(final_audio, count * batch.audio_size());
  share_out(numbers, count,
            std::array{&to.rewards, &to.raw_rewards, &to.lives, &to.frames, &to.episode_frames, &to.numbers});
  share_out(flags, count, std::array{&to.terminated, &to.truncated, &to.finished, &to.game_over});
  if (screens > 0) {
    to.final_observations = bytes_of(final_observations, screens);
  } else {
    to.final_ram = bytes_of(final_observations, count * kRamSize);
  }
  if (final_numbers)
    share_out(*final_numbers, count, std::array{&to.final_lives, &to.final_frames, &to.final_episode_frames});
  if (played) share_out(*played, count, std::array{&to.elapsed, &to.acts, &to.lives_lost});
  return to;
}

// Calls `ask` without the GIL, one thread at a time, and fills the results of all machines.
template <class Ask>
void fill(VectorMachines& self, const Results& results, const Ask& ask) {
  const Turn turn(self.lock());
  Batch& batch = self.batch();
  ask(batch, arrays_of(batch, batch.size(), results));
}

void step(VectorMachines& self, const Given<std::int64_t>& actions, const Results& results) {
  fill(self, results, [&](Batch& batch, const BatchArrays& out) {
    batch.step(std::span<const int>(indices_of(batch, span_of(actions))), out);
  });
}

void step_joysticks(VectorMachines& self, const Joysticks& joysticks, float threshold,
                    const Results& results) {
  fill(self, results, [&](Batch& batch, const BatchArrays& out) {
    batch.step(std::span<const Act>(acts_of({joysticks.data(), joysticks.size()}, threshold)), out);
  });
}

void send(VectorMachines& self, const Given<std::int64_t>& actions, const Given<std::int32_t>& machines) {
  const Turn turn(self.lock());
  Batch& batch = self.batch();
  batch.send(std::span<const int>(indices_of(batch, span_of(actions))), span_of(machines));
}

void send_joysticks(VectorMachines& self, const Joysticks& joysticks, float threshold,
                    const Given<std::int32_t>& machines) {
  const Turn turn(self.lock());
  self.batch().send(std::span<const Act>(acts_of({joysticks.data(), joysticks.size()}, threshold)),
                    span_of(machines));
}

// strengths: the strength of each machine's paddle.
void send_strengths(VectorMachines& self, const Given<std::int64_t>& actions, const Given<float>& strengths,
                    const Given<std::int32_t>& machines) {
  const Turn turn(self.lock());
  Batch& batch = self.batch();
  const std::vector<int> indices = indices_of(batch, span_of(actions));
  if (strengths.size() != indices.size())
    throw InvalidInput("there are " + std::to_string(strengths.size()) + " strengths for " +
                       std::to_string(indices.size()) + " actions");
  std::vector<Act> acts;
  for (std::size_t i = 0; i < indices.size(); ++i)
    acts.push_back({.a = batch.actions(0)[static_cast<std::size_t>(indices[i])], .strength_a = strengths(i)});
  batch.send(std::span<const Act>(acts), span_of(machines));
}

void send_resets(VectorMachines& self, const std::optional<Given<std::int64_t>>& seeds) {
  const Turn turn(self.lock());
  self.batch().send_resets(span_of(seeds));
}

void end_episodes(VectorMachines& self, const Given<std::int32_t>& machines,
                  const std::optional<Given<std::int64_t>>& seeds) {
  const Turn turn(self.lock());
  self.batch().end_episodes(span_of(machines), span_of(seeds));
}

std::size_t playing(VectorMachines& self) {
  const Turn turn(self.lock());
  return self.batch().playing();
}

// Receives as many machines as the results have room for.
void receive(VectorMachines& self, const Results& results) {
  const std::size_t count = std::get<2>(results).shape(1);
  const Turn turn(self.lock());
  Batch& batch = self.batch();
  batch.receive(arrays_of(batch, count, results), count);
}

void reset(VectorMachines& self, const std::optional<Given<bool>>& reset_mask,
           const std::optional<Given<std::int64_t>>& seeds, const Results& results) {
  const std::span<const bool> mask = span_of(reset_mask);
  const std::vector<std::uint8_t> bytes(mask.begin(), mask.end());
  fill(self, results, [&](Batch& batch, const BatchArrays& out) { batch.reset(out, bytes, span_of(seeds)); });
}

void show(VectorMachines& self, const Results& results) {
  fill(self, results, [](Batch& batch, const BatchArrays& out) { batch.show(out); });
}

// States and screens of one machine

Slot& slot_of(Batch& batch, std::int64_t machine) {
  if (machine < 0 || static_cast<std::size_t>(machine) >= batch.size())
    throw std::out_of_range("environment " + std::to_string(machine) + " is out of range; accepted: 0 to " +
                            std::to_string(batch.size() - 1));
  return batch.slot(static_cast<std::size_t>(machine));
}

SavedMachine save(VectorMachines& self, std::int64_t machine, bool include_rng) {
  const Turn turn(self.lock());
  const Slot& slot = slot_of(self.batch(), machine);
  return {slot, self.cartridge(static_cast<std::size_t>(machine)), include_rng};
}

void restore(VectorMachines& self, std::int64_t machine, const SavedMachine& state) {
  const Turn turn(self.lock());
  state.restore_in(slot_of(self.batch(), machine));
}

nb::bytes bytes_of_state(const SavedMachine& state) {
  std::string bytes;
  {
    const WithoutGil other_threads_run;
    bytes = state.serialize();
  }
  return nb::bytes(bytes.data(), bytes.size());
}

Bytes screen(VectorMachines& self, std::int64_t machine) {
  FreshBytes bytes;
  std::size_t height = 0;
  {
    const Turn turn(self.lock());
    const Environment& environment = slot_of(self.batch(), machine).environment();
    height = static_cast<std::size_t>(environment.height());
    bytes = FreshBytes(height * kScreenWidth * 3);
    environment.screen_rgb(bytes.span());
  }
  return std::move(bytes).array({height, kScreenWidth, 3});
}

// Making them

// An image and the name of its game. Without a name, the game file or the image decides.
using GivenImage = std::pair<ImageArgument, std::optional<std::string>>;
using Console = std::map<std::string, std::string>;  // keys and values of PropertyOverrides

Cartridge cartridge_of(const GivenImage& source, const std::optional<std::string>& game_file,
                       const Console& console) {
  const auto& [where, game] = source;
  PropertyOverrides properties;
  for (const auto& [key, value] : console) properties.set(key, value);
  auto image = image_of(where, game.value_or("bytes"));
  auto rules = with_overrides(recognise(*image, game, game_file).game, *image, properties);
  return {std::move(image), std::move(rules)};
}

void make(VectorMachines* self, const std::vector<GivenImage>& images, const Given<std::int32_t>& of_machines,
          BatchSettings settings, const std::optional<std::string>& game_file, const Console& console) {
  const WithoutGil other_threads_run;
  settings.noun = "environment";
  check_memory(of_machines.size(), settings.noun);
  std::vector<Cartridge> games;
  for (const GivenImage& image : images) games.push_back(cartridge_of(image, game_file, console));
  std::vector<Cartridge> cartridges;
  for (const std::int32_t game : span_of(of_machines))
    cartridges.push_back(games.at(static_cast<std::size_t>(game)));
  new (self) VectorMachines(cartridges, settings);
}

// Returns a sentence for each image whose game has a rule that was written for another image.
std::vector<std::string> image_warnings(VectorMachines& self) {
  const Turn turn(self.lock());
  std::set<std::string> sentences;
  for (std::size_t machine = 0; machine < self.batch().size(); ++machine) {
    const Cartridge& cartridge = self.cartridge(machine);
    sentences.insert(image_warning(*cartridge.game, *cartridge.image));
  }
  sentences.erase("");
  return {sentences.begin(), sentences.end()};
}

std::vector<std::size_t> numbers_of_actions(VectorMachines& self) {
  const Turn turn(self.lock());
  std::vector<std::size_t> counts;
  for (std::size_t machine = 0; machine < self.batch().size(); ++machine)
    counts.push_back(self.batch().actions(machine).size());
  return counts;
}

std::vector<int> actions_of(VectorMachines& self, std::int64_t machine) {
  const Turn turn(self.lock());
  slot_of(self.batch(), machine);  // throws
  return self.batch().actions(static_cast<std::size_t>(machine));
}

int height(VectorMachines& self) {
  const Turn turn(self.lock());
  return self.batch().height();
}

}  // namespace

void bind_vector(nb::module_& module) {
  nb::class_<SavedMachine>(module, "SavedMachine",
                           "The state of one environment of a vector. It can be pickled and copied.")
      .def("__getstate__", bytes_of_state)
      .def("__setstate__", [](SavedMachine& self, const nb::bytes& bytes) {
        new (&self) SavedMachine(std::string(bytes.c_str(), bytes.size()));
      });
  const auto results = "results"_a.noconvert();
  nb::class_<VectorMachines>(module, "VectorMachines", "Machines that are stepped together on threads.")
      .def("__init__", make, "images"_a, "of_machines"_a.noconvert(), "settings"_a,
           "game_file"_a = nb::none(), "console"_a = Console(),
           nb::sig(
               "def __init__(self, images: list[tuple[str | os.PathLike[str] | bytes, str | None]], "
               "of_machines: NDArray[numpy.int32], settings: VectorSettings, game_file: str | None = None, "
               "console: dict[str, str] = {}) -> None"))
      .def("image_warnings", image_warnings,
           "Returns a warning for each image that the rule of another image scores.")
      .def("step", step, "actions"_a.noconvert(), results)
      .def("step_joysticks", step_joysticks, "joysticks"_a.noconvert(), "threshold"_a, results)
      .def("send", send, "actions"_a.noconvert(), "machines"_a.noconvert())
      .def("send_joysticks", send_joysticks, "joysticks"_a.noconvert(), "threshold"_a,
           "machines"_a.noconvert())
      .def("send_strengths", send_strengths, "actions"_a.noconvert(), "strengths"_a.noconvert(),
           "machines"_a.noconvert())
      .def("send_resets", send_resets, "seeds"_a.none())
      .def("end_episodes", end_episodes, "machines"_a.noconvert(), "seeds"_a.none() = nb::none(),
           "Makes the next step of each machine begin a new game; a seed of -1 means unseeded.")
      .def("playing", playing, "Returns how many machines were sent and not yet received.")
      .def("receive", receive, results, "Waits for as many machines as the results have columns.")
      .def("reset", reset, "reset_mask"_a.none(), "seeds"_a.none(), results)
      .def("show", show, results)
      .def("save", save, "machine"_a, "include_rng"_a)
      .def("restore", restore, "machine"_a, "state"_a)
      .def("screen", screen, "machine"_a, "Returns the screen of a machine, uint8 of shape (height, 160, 3).")
      .def("numbers_of_actions", numbers_of_actions, "Returns the size of the action set of each machine.")
      .def("actions_of", actions_of, "machine"_a,
           "Returns the action set of a machine, as numbers of Action.")
      .def("height", height, "Returns the rows of the tallest screen.");
}

}  // namespace racebeam::python
