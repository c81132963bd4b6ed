#include "environment/observe/preprocess.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <tuple>

#include "environment/environment.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kRow = kScreenWidth;

bool same_row(const std::uint8_t* a, const std::uint8_t* b) { return std::memcmp(a, b, kRow) == 0; }

// Calls make(at) for each stale row. One that equals the row above, as same_as_above(at) says, is copied.
template <typename Same, typename Make>
void make_rows(RowFlags stale, std::span<std::uint8_t> plane, Same same_as_above, Make make) {
  for (std::size_t at = 0; at < plane.size(); at += kRow) {
    if (stale[at / kRow] == 0) continue;
    if (at > 0 && same_as_above(at)) {
      std::memcpy(&plane[at], &plane[at - kRow], kRow);
    } else {
      make(at);
    }
  }
}

std::array<BrightnessTable, 3> make_colour_tables(Format format) {
  std::array<BrightnessTable, 3> tables{};
  const Palette& colours = palette(format);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    tables[0][i] = colours[i].r;
    tables[1][i] = colours[i].g;
    tables[2][i] = colours[i].b;
  }
  return tables;
}

}  // namespace

const std::array<BrightnessTable, 3>& colour_tables(Format format) {
  static const std::array<std::array<BrightnessTable, 3>, 4> all = {
      make_colour_tables(Format::kNtsc), make_colour_tables(Format::kPal), make_colour_tables(Format::kPal60),
      make_colour_tables(Format::kSecam)};
  switch (format) {
    case Format::kPal: return all[1];
    case Format::kPal60: return all[2];
    case Format::kSecam: return all[3];
    default: return all[0];
  }
}

void make_plane(std::span<const std::uint8_t> screen, const Brightness& brightness, RowFlags stale,
                std::span<std::uint8_t> plane) {
  const std::uint8_t* const one = screen.data();
  make_rows(
      stale, plane, [=](std::size_t at) { return same_row(one + at, one + at - kRow); },
      [&](std::size_t at) { brightness.make_row(one + at, &plane[at]); });
}

void make_brighter_plane(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> previous,
                         const Brightness& brightness, RowFlags stale, std::span<std::uint8_t> plane) {
  const std::uint8_t *const one = screen.data(), *const other = previous.data();
  make_rows(
      stale, plane,
      [=](std::size_t at) {
        return same_row(one + at, one + at - kRow) && same_row(other + at, other + at - kRow);
      },
      [&](std::size_t at) { brightness.make_brighter_row(one + at, other + at, &plane[at]); });
}

const ScreenResize& screen_resize(int height, int to_width, int to_height) {
  static std::mutex mutex;
  static std::map<std::tuple<int, int, int>, ScreenResize> all;
  const std::lock_guard lock(mutex);
  const std::tuple key(height, to_width, to_height);
  const auto found = all.find(key);
  if (found != all.end()) return found->second;
  if (to_width > kScreenWidth || to_height > height)
    return all.emplace(key, Enlargement(kScreenWidth, height, to_width, to_height)).first->second;
  if (BlockMean::fits(kScreenWidth, height, to_width, to_height))
    return all.emplace(key, BlockMean(kScreenWidth, height, to_width, to_height)).first->second;
  return all.emplace(key, AreaResize(kScreenWidth, height, to_width, to_height)).first->second;
}

}  // namespace racebeam
