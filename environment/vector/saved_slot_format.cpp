#include "environment/vector/saved_slot_format.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "emulator/base/range_check.hpp"
#include "environment/saved/saved_state_format.hpp"
#include "environment/saved/state_bytes.hpp"
#include "environment/saved_state.hpp"

namespace racebeam {

using namespace state_bytes;

namespace {

struct SlotHeader {
  char magic[8];
  std::uint32_t version;
  std::uint32_t total_size;
  std::uint32_t checksum;  // of everything after the header
};
static_assert(sizeof(SlotHeader) == 20);

// After it come the stack, the generator's words if they are there, and the machine's state.
struct SlotValues {
  std::int64_t score;
  std::int32_t elapsed, lives;
  std::int32_t depth, width, height;  // of the stack
  std::uint32_t machine_size;         // bytes of the machine's state
  std::uint8_t rgb;
  std::uint8_t finished, game_continues, terminated, truncated, blends;
  std::uint8_t has_noops;
  std::uint8_t unused;

  StackSettings stack() const { return {.depth = depth, .width = width, .height = height, .rgb = rgb != 0}; }
  std::uint64_t stack_size() const {
    return std::uint64_t{1} * static_cast<unsigned>(depth) * static_cast<unsigned>(width) *
           static_cast<unsigned>(height) * static_cast<unsigned>(stack().channels());
  }
  std::uint64_t size_of_rest() const {
    return stack_size() + (has_noops != 0 ? sizeof(GeneratorWords) : 0) + machine_size;
  }
};
static_assert(sizeof(SlotValues) == 40);

constexpr char kSlotMagic[8] = {'R', 'B', 'S', 'L', 'O', 'T', '\r', '\n'};
constexpr std::int64_t kMaxScore = std::int64_t{1} << 62, kMaxFrames = 1 << 30;  // sums stay in range
constexpr int kMaxDepth = 1 << 16;

void check_values(const SlotValues& values) {
  check_range("the score", values.score, -kMaxScore, kMaxScore);
  check_range("the number of frames played", values.elapsed, 0, kMaxFrames);
  check_range("the number of screens in the stack", values.depth, 0, kMaxDepth);
  check_range("the width of a screen in the stack", values.width, 0, 2 * kScreenWidth);
  check_range("the height of a screen in the stack", values.height, 0,
              std::numeric_limits<std::int16_t>::max());
  check_flag("the flag of colours", values.rgb);
  check_flag("the flag of the episode's end", values.finished);
  check_flag("the flag of a game that goes on", values.game_continues);
  check_flag("the flag of termination", values.terminated);
  check_flag("the flag of truncation", values.truncated);
  check_flag("the flag of two frames", values.blends);
  check_flag("the flag of the generator of no-ops", values.has_noops);
  check_range("the unused byte", values.unused, 0, 0);
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const Slot::Saved& saved, const Environment& environment) {
  const std::vector<std::uint8_t> machine = to_bytes(*saved.machine, environment);
  const auto& progress = saved.progress;
  const StackSettings& stack = saved.stack_settings;
  const SlotValues values{progress.score,
                          progress.elapsed,
                          progress.lives,
                          stack.depth,
                          stack.width,
                          stack.height,
                          static_cast<std::uint32_t>(machine.size()),
                          stack.rgb,
                          progress.finished,
                          progress.game_continues,
                          progress.terminated,
                          progress.truncated,
                          progress.blends,
                          saved.noops != nullptr,
                          0};
  std::vector<std::uint8_t> bytes(sizeof(SlotHeader));
  bytes.reserve(sizeof(SlotHeader) + sizeof values + static_cast<std::size_t>(values.size_of_rest()));
  append(bytes, values);
  bytes.insert(bytes.end(), saved.stack.begin(), saved.stack.end());
  if (saved.noops) append(bytes, words_of(*saved.noops));
  bytes.insert(bytes.end(), machine.begin(), machine.end());

  SlotHeader header{{},
                    kSavedSlotVersion,
                    static_cast<std::uint32_t>(bytes.size()),
                    checksum(std::span(bytes).subspan(sizeof(SlotHeader)))};
  std::ranges::copy(kSlotMagic, header.magic);
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

bool is_saved_slot(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= sizeof kSlotMagic && std::ranges::equal(bytes.first(sizeof kSlotMagic), kSlotMagic);
}

void check_saved_slot(std::span<const std::uint8_t> bytes) {
  const std::size_t size = bytes.size();
  if (size < sizeof(SlotHeader) + sizeof(SlotValues) || !is_saved_slot(bytes))
    throw InvalidInput("these " + std::to_string(size) + " bytes are not a state of a vector environment");
  const auto header = take<SlotHeader>(bytes);
  if (header.version != kSavedSlotVersion)
    throw InvalidInput("the state was saved by another version of racebeam (format " +
                       std::to_string(header.version) + "; this one reads format " +
                       std::to_string(kSavedSlotVersion) + ")");
  if (header.total_size != size)
    throw InvalidInput("the state has " + std::to_string(size) + " bytes instead of " +
                       std::to_string(header.total_size) + "; it was truncated, or bytes were added");
  if (header.checksum != checksum(bytes)) throw InvalidInput("the state was altered: its checksum is wrong");
}

Slot::Saved saved_slot(std::span<const std::uint8_t> bytes, const Environment& environment) {
  check_saved_slot(bytes);
  bytes = bytes.subspan(sizeof(SlotHeader));
  const auto values = take<SlotValues>(bytes);
  check_values(values);
  if (values.size_of_rest() != bytes.size()) throw InvalidInput("the state's size contradicts its header");

  Slot::Saved saved;
  saved.progress = {.score = values.score,
                    .elapsed = values.elapsed,
                    .lives = values.lives,
                    .finished = values.finished != 0,
                    .game_continues = values.game_continues != 0,
                    .terminated = values.terminated != 0,
                    .truncated = values.truncated != 0,
                    .blends = values.blends != 0};
  saved.stack_settings = values.stack();
  const auto stack = bytes.first(static_cast<std::size_t>(values.stack_size()));
  saved.stack.assign(stack.begin(), stack.end());
  bytes = bytes.subspan(stack.size());
  if (values.has_noops != 0)
    saved.noops = std::make_shared<const MersenneTwister>(generator_of(take<GeneratorWords>(bytes)));
  saved.machine = from_bytes(bytes, environment);
  saved.with_random = saved.machine->random != nullptr;
  return saved;
}

}  // namespace racebeam
