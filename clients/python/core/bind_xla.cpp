// Steps and resets of machines as custom calls of XLA, which programs that JAX compiled make
// (racebeam/xla.py).
#include <nanobind/stl/string.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <mutex>
#include <stdexcept>

#include "clients/python/core/bindings.hpp"
#include "clients/python/core/vector_acts.hpp"
#include "clients/python/core/vector_machines.hpp"
#include "clients/python/core/xla_ffi.hpp"
#include "system/invalid_input.hpp"

namespace racebeam::python {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

// Handles are numbers by which a compiled program names machines. A number is never used twice, and an
// unknown one is an error.

std::mutex handles_mutex;
std::map<std::uint64_t, std::weak_ptr<SharedBatch>> handles;
std::uint64_t last_handle = 0;

std::uint64_t handle_of(const VectorMachines& self) {
  const std::scoped_lock hold(handles_mutex);
  std::erase_if(handles, [](const auto& entry) { return entry.second.expired(); });
  handles[++last_handle] = self.shared();
  return last_handle;
}

std::shared_ptr<SharedBatch> named_by(std::uint64_t handle) {
  const std::scoped_lock hold(handles_mutex);
  const auto found = handles.find(handle);
  auto shared = found == handles.end() ? nullptr : found->second.lock();
  if (!shared) throw std::runtime_error("the environments of this handle were closed; make new ones");
  return shared;
}

// Buffers

template <class T>
constexpr xla::DataType type_of() {
  if (std::is_same_v<T, bool>) return xla::DataType::kBool;
  if (std::is_same_v<T, std::uint8_t>) return xla::DataType::kUint8;
  return std::is_same_v<T, float> ? xla::DataType::kFloat32 : xla::DataType::kInt32;
}

// Returns one buffer after the other. Throws InvalidInput for a buffer of another type or size.
class Reader {
 public:
  explicit Reader(const xla::Buffers& buffers) : buffers_(buffers) {}

  bool is_done() const { return next_ == buffers_.size; }

  std::size_t size_of_next() const { return size_of(next_buffer()); }

  template <class T>
  std::span<T> next(std::size_t count) {
    const xla::Buffer& buffer = next_buffer();
    if (buffer.type != type_of<std::remove_const_t<T>>() || size_of(buffer) != count)
      throw InvalidInput("buffer " + std::to_string(next_) + " of a call of XLA has another type, or not " +
                         std::to_string(count) + " values");
    ++next_;
    return {static_cast<T*>(buffer.data), count};
  }

 private:
  const xla::Buffer& next_buffer() const {
    if (is_done()) throw InvalidInput("a call of XLA has too few buffers");
    return *static_cast<const xla::Buffer*>(buffers_.buffers[next_]);
  }

  static std::size_t size_of(const xla::Buffer& buffer) {
    std::size_t size = 1;
    for (std::int64_t axis = 0; axis < buffer.rank; ++axis)
      size *= static_cast<std::size_t>(buffer.shape[axis]);
    return size;
  }

  const xla::Buffers& buffers_;
  std::int64_t next_ = 0;
};

std::span<std::uint8_t> as_bytes(std::span<bool> flags) {
  static_assert(sizeof(bool) == 1);
  return {reinterpret_cast<std::uint8_t*>(flags.data()), flags.size()};
}

// The results that racebeam.xla.RESULTS lists, in its order.
BatchArrays results_of(const Batch& batch, std::size_t count, Reader& results) {
  BatchArrays to;
  if (batch.observation_size() > 0) {
    to.observations = results.next<std::uint8_t>(count * batch.observation_size());
  } else {
    to.ram = results.next<std::uint8_t>(count * kRamSize);
  }
  to.rewards = results.next<std::int32_t>(count);
  to.terminated = as_bytes(results.next<bool>(count));
  to.truncated = as_bytes(results.next<bool>(count));
  for (auto* const numbers : {&to.numbers, &to.lives, &to.frames, &to.episode_frames, &to.raw_rewards})
    *numbers = results.next<std::int32_t>(count);
  to.game_over = as_bytes(results.next<bool>(count));
  return to;
}

// The results that racebeam.envpool.xla.RESULTS lists: those of results_of(), then those that only EnvPool
// has.
BatchArrays received_of(const Batch& batch, Reader& results) {
  const std::size_t count = batch.batch_size();
  BatchArrays to = results_of(batch, count, results);
  to.ram = results.next<std::uint8_t>(count * kRamSize);
  for (auto* const numbers : {&to.elapsed, &to.acts, &to.lives_lost})
    *numbers = results.next<std::int32_t>(count);
  return to;
}

// Calls

// Arguments: the actions, or joysticks and their threshold.
void play_step(Batch& batch, Reader& arguments, Reader& results) {
  const std::vector<int> indices = indices_of(batch, arguments.next<const std::int32_t>(batch.size()));
  batch.step(std::span<const int>(indices), results_of(batch, batch.size(), results));
}

void play_step_joysticks(Batch& batch, Reader& arguments, Reader& results) {
  const auto joysticks = arguments.next<const float>(3 * batch.size());
  const std::vector<Act> acts = acts_of(joysticks, arguments.next<const float>(1)[0]);
  batch.step(std::span<const Act>(acts), results_of(batch, batch.size(), results));
}

// Arguments: the seeds, where a negative one means unseeded, and which machines are reset.
void play_reset(Batch& batch, Reader& arguments, Reader& results) {
  const auto seeds = arguments.next<const std::int32_t>(batch.size());
  const auto mask = arguments.next<const bool>(batch.size());
  batch.reset(results_of(batch, batch.size(), results), std::vector<std::uint8_t>(mask.begin(), mask.end()),
              std::vector<std::int64_t>(seeds.begin(), seeds.end()));
}

// Arguments: the actions, and the indices of their machines.
void play_send(Batch& batch, Reader& arguments, Reader&) {
  const std::size_t count = arguments.size_of_next();
  const std::vector<int> indices = indices_of(batch, arguments.next<const std::int32_t>(count));
  batch.send(std::span<const int>(indices), arguments.next<const std::int32_t>(count));
}

void play_receive(Batch& batch, Reader&, Reader& results) { batch.receive(received_of(batch, results)); }

// The first argument is a handle, and so is the first result, which makes the next call depend on this one.
template <class Ask>
void answer(const xla::CallFrame& frame, const Ask& ask) {
  Reader arguments(frame.arguments), results(frame.results);
  const auto bytes = arguments.next<const std::uint8_t>(sizeof(std::uint64_t));
  std::uint64_t handle = 0;
  std::memcpy(&handle, bytes.data(), sizeof handle);
  std::ranges::copy(bytes, results.next<std::uint8_t>(sizeof handle).begin());
  const auto shared = named_by(handle);
  const std::scoped_lock hold(shared->lock());
  Batch& batch = shared->batch(nullptr);  // only calls from Python check for signals
  ask(batch, arguments, results);
}

xla::Error* error_of(const xla::CallFrame& frame, xla::ErrorCode code, const char* sentence) {
  xla::ErrorCreateArgs arguments{sizeof arguments, nullptr, sentence, code};
  return frame.api->error_create(&arguments);
}

// Answers XLA if it asks for the version. Returns whether it did.
bool tells_version(const xla::CallFrame& frame) {
  if (!frame.extensions || frame.extensions->type != xla::kMetadataExtension) return false;
  xla::Metadata& metadata = *reinterpret_cast<xla::MetadataExtension*>(frame.extensions)->metadata;
  metadata.api_version.major_version = xla::kMajorVersion;
  metadata.api_version.minor_version = std::min(xla::kMinorVersion, frame.api->api_version.minor_version);
  metadata.traits = 0;
  return true;
}

template <auto ask>
xla::Error* handle_call(xla::CallFrame* frame) {
  try {
    if (!tells_version(*frame)) answer(*frame, ask);
    return nullptr;
  } catch (const std::out_of_range& error) {
    return error_of(*frame, xla::ErrorCode::kOutOfRange, error.what());
  } catch (const InvalidInput& error) {
    return error_of(*frame, xla::ErrorCode::kInvalidArgument, error.what());
  } catch (const std::exception& error) {
    return error_of(*frame, xla::ErrorCode::kFailedPrecondition, error.what());
  }
}

nb::dict targets() {
  const std::pair<const char*, xla::Handler*> all[] = {{"step", handle_call<play_step>},
                                                       {"step_joysticks", handle_call<play_step_joysticks>},
                                                       {"reset", handle_call<play_reset>},
                                                       {"send", handle_call<play_send>},
                                                       {"receive", handle_call<play_receive>}};
  nb::dict found;
  for (const auto& [name, handler] : all) found[name] = nb::capsule(reinterpret_cast<void*>(handler));
  return found;
}

}  // namespace

void bind_xla(nb::module_& module) {
  module.def("xla_targets", targets, nb::sig("def xla_targets() -> dict[str, object]"),
             "Returns the custom calls by name, for jax.ffi.register_ffi_target().");
  module.def("xla_handle", handle_of, "machines"_a,
             "Returns the number that names the machines in custom calls.");
}

}  // namespace racebeam::python
