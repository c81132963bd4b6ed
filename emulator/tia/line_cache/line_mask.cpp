#include "emulator/tia/line_cache/line_mask.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>

namespace racebeam {
namespace {

constexpr std::size_t kMost = 1 << 14;

// A bit for each byte.
struct Key {
  std::uint64_t counts = 0, sets = 0;
  auto operator<=>(const Key&) const = default;
};

// Elements of a map do not move.
const LineMask* find_or_add(const Key& key, const RegisterVectors& counts, const RegisterVectors& sets) {
  static std::mutex mutex;
  static std::map<Key, LineMask> all;
  const std::lock_guard lock(mutex);
  if (const auto found = all.find(key); found != all.end()) return &found->second;
  if (all.size() == kMost) return nullptr;
  LineMask& mask = all[key];
  counts.write(mask.counts);
  sets.write(mask.sets);
  return &mask;
}

}  // namespace

const LineMask* LineMask::find(const RegisterVectors& counts, const RegisterVectors& sets) {
  struct Entry {
    Key key;
    const LineMask* mask = nullptr;
  };
  thread_local std::array<Entry, 256> recent;
  const Key key{counts.bytes_set(), sets.bytes_set()};
  Entry& entry = recent[(key.counts * 0x9E3779B97F4A7C15 ^ key.sets * 0xC2B2AE3D27D4EB4F) >> 56];
  if (entry.mask == nullptr || entry.key != key) entry = {key, find_or_add(key, counts, sets)};
  return entry.mask;
}

}  // namespace racebeam
