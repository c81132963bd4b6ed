#include "emulator/tia/line_cache/line_mask.hpp"

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <new>

namespace racebeam {
namespace {

constexpr std::size_t kMax = 1 << 14;

struct Key {
  ByteSet counts = 0, sets = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): a fault of clang-tidy 14
  auto operator<=>(const Key&) const = default;
};

constexpr TiaRegisters mask_of(ByteSet set) {
  TiaBytes bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = set >> i & 1 ? 0xFF : 0;
  return std::bit_cast<TiaRegisters>(bytes);
}

// Elements of a map do not move. Null also if memory has run out: no exception can pass translated code,
// which may be waiting for a line.
const LineMask* find_or_add(const Key& key) try {
  static std::mutex mutex;
  static std::map<Key, LineMask> all;
  const std::lock_guard lock(mutex);
  if (const auto found = all.find(key); found != all.end()) return &found->second;
  if (all.size() == kMax) return nullptr;
  return &(all[key] = {mask_of(key.counts), mask_of(key.sets)});
} catch (const std::bad_alloc&) {
  return nullptr;
}

}  // namespace

constinit const LineMask LineMask::kWhole = {mask_of(~ByteSet{0}), mask_of(~ByteSet{0})};

const LineMask* LineMask::find(ByteSet counts, ByteSet sets) {
  struct Entry {
    Key key;
    const LineMask* mask = nullptr;
  };
  thread_local std::array<Entry, 256> recent;
  const Key key{counts, sets};
  Entry& entry = recent[(key.counts * 0x9E3779B97F4A7C15 ^ key.sets * 0xC2B2AE3D27D4EB4F) >> 56];
  if (entry.mask == nullptr || entry.key != key) entry = {key, find_or_add(key)};
  return entry.mask;
}

}  // namespace racebeam
